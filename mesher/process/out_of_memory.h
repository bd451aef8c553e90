#pragma once

#include <cstddef>

namespace collarmesh::process {

/// From now on an allocation that fails ends the program with exit code 5, wherever it happens: nothing is
/// unwound, as destructors and libraries may need memory, too. Unfinished files are removed. An exception
/// that nobody catches ends it in the same way, with exit code 1.
void end_when_memory_is_used_up();

/// The process gets about so many bytes from now on for everything it does; 0: any number.
void limit_memory(std::size_t bytes);

/// Is more than half of the limit in use? After a crash in a library that tells whether memory is a likely
/// cause. May be called in a signal handler.
bool memory_is_short();

}  // namespace collarmesh::process
