#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Certifies a mesh file; prints findings and measures to standard output.
ExitCode check_command(process::Process& process, const CheckArguments& arguments);

}  // namespace collarmesh::cli
