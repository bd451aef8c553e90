#pragma once

#include <functional>

#include "arguments.h"
#include "command/stages.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Reads the input, builds the complex, meshes it, certifies and writes the mesh. Throws the library's
/// exceptions.
ExitCode mesh_command(process::Process& process, const MeshArguments& arguments);

/// Makes a mesh and writes it, with reports, and prints a summary: the common part of all commands that make
/// a mesh.
ExitCode make_and_write(process::Process& process, const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make);

/// Prints the problems of a mesh to standard error and, unless quiet, its summary.
void tell_of(const process::Console& console, const MeshArguments& arguments, const report::MeshRun& run);

}  // namespace collarmesh::cli
