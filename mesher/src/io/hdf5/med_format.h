#pragma once

/// What the writer and the reader of .med files have to agree on.
namespace collarmesh::io {

constexpr const char* med_partition_field = "partition";  // whole numbers on the cells

}  // namespace collarmesh::io
