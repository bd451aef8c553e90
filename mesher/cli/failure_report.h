#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// If this command makes a mesh, lets a later failure write the requested reports: the error, its stage, and
/// the progress so far.
void report_failures_of(process::Process& process, const Arguments& arguments);

}  // namespace collarmesh::cli
