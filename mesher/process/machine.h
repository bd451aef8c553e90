#pragma once

#include <cstddef>

namespace collarmesh::process {

/// Returns the bytes of memory that this program may use: the machine's, or fewer if its control group is
/// limited.
std::size_t memory_of_the_machine();

}  // namespace collarmesh::process
