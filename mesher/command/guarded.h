#pragma once

#include <functional>

#include "process/process.h"

namespace collarmesh::command {

/// Runs a command; turns exceptions into a message on standard error and an exit code.
process::ExitCode guarded(process::Process& process, const std::function<process::ExitCode()>& command);

}  // namespace collarmesh::command
