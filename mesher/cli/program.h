#pragma once

#include <functional>

#include "process/exit_code.h"

namespace collarmesh::cli {

using process::ExitCode;

/// The whole program; returns its exit code (exit_code.h).
int run(int argc, const char* const* argv);

/// Runs a command; what it throws becomes a message on standard error and an exit code.
ExitCode guarded(const std::function<ExitCode()>& command);

}  // namespace collarmesh::cli
