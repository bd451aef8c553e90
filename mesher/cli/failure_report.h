#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Makes a later failure of this command write the reports that the command requests, if any: the error, the
/// stage in which it occurred, and the progress until then.
void report_failures_of(process::Process& process, const Arguments& arguments);

}  // namespace collarmesh::cli
