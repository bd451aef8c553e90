#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Converts files and reports what was merged, welded and dropped. Meshing a surface may end with the exit
/// codes of `mesh_command`.
ExitCode convert_command(process::Process& process, const ConvertArguments& arguments);

}  // namespace collarmesh::cli
