#pragma once

#include "files/complex_input.h"
#include "process/process.h"

namespace collarmesh::command {

/// Returns settings for reading a command's input: the given ones, but reading ends when the command is
/// interrupted, and work on CAD files is reported to the supervisor.
files::InputReading interruptible(process::Process& process, files::InputReading reading);

}  // namespace collarmesh::command
