#pragma once

#include <string_view>

#include "process/exit_code.h"

namespace collarmesh::process {

/// What a command does when it fails, wherever it fails: it leaves reports for programs.
using FailureHandler = void (*)(ExitCode code, std::string_view message);
void on_failure(FailureHandler handler);

/// Calls the handler, if there is one. It may have no memory, and is called by any thread.
void failed(ExitCode code, std::string_view message);

}  // namespace collarmesh::process
