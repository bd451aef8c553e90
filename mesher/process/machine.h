#pragma once

#include <cstddef>

namespace collarmesh::process {

/// Returns the number of bytes of memory that this program may use: the machine's, or less if its control
/// group has a limit.
std::size_t memory_of_the_machine();

}  // namespace collarmesh::process
