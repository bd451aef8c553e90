#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Describes the complex, or the mesh, on standard output.
ExitCode info_command(process::Process& process, const InfoArguments& arguments);

}  // namespace collarmesh::cli
