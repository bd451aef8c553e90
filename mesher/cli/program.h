#pragma once

#include <functional>

#include "process/process.h"

namespace collarmesh::cli {

using process::ExitCode;

/// Runs the whole program; returns its exit code (exit_code.h).
int run(process::Process& process, int argc, const char* const* argv);

/// Runs a command; turns exceptions into a message on standard error and an exit code.
ExitCode guarded(process::Process& process, const std::function<ExitCode()>& command);

}  // namespace collarmesh::cli
