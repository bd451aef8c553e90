#pragma once

#include <string_view>

#include "process/exit_code.h"

namespace collarmesh::process {

/// A function that is called when a command fails anywhere; it writes the requested reports.
using FailureHandler = void (*)(ExitCode code, std::string_view message);
void on_failure(FailureHandler handler);

/// Calls the handler, if there is one. Any thread may call it, possibly when memory is used up.
void failed(ExitCode code, std::string_view message);

}  // namespace collarmesh::process
