#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Reads a mesh, adapts it to sizes, certifies and writes it. Throws the library's exceptions.
ExitCode remesh_command(process::Process& process, const RemeshArguments& arguments);

}  // namespace collarmesh::cli
