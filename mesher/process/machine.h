#pragma once

#include <cstddef>

namespace collarmesh::process {

/// Bytes of memory that this program may have: the machine's, or less where the control group that it
/// runs in is limited.
std::size_t memory_of_the_machine();

}  // namespace collarmesh::process
