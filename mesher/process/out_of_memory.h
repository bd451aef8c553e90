#pragma once

#include <cstddef>

namespace collarmesh::process {

/// Makes any later failed allocation end the program with exit code 5, wherever it happens. Unwinds nothing,
/// because destructors and libraries may need memory, too. Removes unfinished files. Makes an uncaught
/// exception end the program in the same way, with exit code 1.
void end_when_memory_is_used_up();

/// Limits the memory of the process to about this many bytes from now on; 0: no limit.
void limit_memory(std::size_t bytes);

/// Returns whether more than half of the limit is in use: after a crash in a library, this tells whether lack
/// of memory is a likely cause. May be called in a signal handler.
bool memory_is_short();

}  // namespace collarmesh::process
