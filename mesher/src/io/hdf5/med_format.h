#pragma once

/// The conventions that the writer and the reader of .med files share.
namespace collarmesh::io {

constexpr const char* med_partition_field = "partition";  // whole numbers on the cells

}  // namespace collarmesh::io
