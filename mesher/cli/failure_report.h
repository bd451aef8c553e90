#pragma once

#include <string_view>

#include "arguments.h"
#include "collarmesh/error.h"
#include "process/exit_code.h"

namespace collarmesh::cli {

/// From now on a failure of this command writes the reports that it was asked for.
void report_failures_of(const Arguments& arguments);

/// Writes them: what failed, in which stage, and how far it came. The first call counts; without reports, or
/// where they cannot be written, nothing happens.
void report_failure(ExitCode code, std::string_view message, const PlcError* faults = nullptr) noexcept;

}  // namespace collarmesh::cli
