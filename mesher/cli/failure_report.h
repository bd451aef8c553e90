#pragma once

#include <string_view>

#include "arguments.h"
#include "collarmesh/error.h"
#include "process/exit_code.h"

namespace collarmesh::cli {

/// Makes a later failure of this command write the requested reports.
void report_failures_of(const Arguments& arguments);

/// Writes the reports: the error, its stage, and the progress so far. Only the first call writes. Does
/// nothing if no reports are requested, or if they cannot be written.
void report_failure(ExitCode code, std::string_view message, const PlcError* faults = nullptr) noexcept;

}  // namespace collarmesh::cli
