#pragma once

#include <cstddef>

namespace collarmesh::process {

/// Returns the number of bytes of memory that this program may use: the machine's, or less if its control
/// group has a limit.
std::size_t memory_of_the_machine();

/// Limits the memory of this process to about this many bytes from now on; 0: no limit.
void limit_memory(std::size_t bytes);

/// Returns whether more than half of the memory that the limit permits is in use; false without a limit.
/// After a crash in a library this tells whether lack of memory is a likely cause. May be called in a signal
/// handler.
bool memory_is_short();

}  // namespace collarmesh::process
