#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Makes a later failure of this command write the requested reports, if it makes a mesh: the error, its
/// stage, and the progress so far.
void report_failures_of(process::Process& process, const Arguments& arguments);

}  // namespace collarmesh::cli
