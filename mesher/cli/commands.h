#pragma once

#include <functional>

#include "arguments.h"
#include "command/stages.h"
#include "process/process.h"

/// The commands of the program. They throw the library's exceptions, and Stopped.
namespace collarmesh::cli {

/// Reads the input, builds the complex, meshes it, certifies and writes the mesh.
ExitCode mesh_command(process::Process& process, const MeshArguments& arguments);

/// Reads a mesh, adapts it to sizes, certifies and writes it.
ExitCode remesh_command(process::Process& process, const RemeshArguments& arguments);

/// Certifies a mesh file; prints findings and measures to standard output.
ExitCode check_command(process::Process& process, const CheckArguments& arguments);

/// Describes the input, a complex or a mesh, on standard output.
ExitCode info_command(process::Process& process, const InfoArguments& arguments);

/// Writes the facets that the mesher would use: repaired, or unchanged if they are a valid complex. Throws
/// PlcError if they cannot be repaired.
ExitCode repair_command(process::Process& process, const RepairArguments& arguments);

/// Converts files and reports what was merged, welded and dropped. Meshing a surface may end with the exit
/// codes of `mesh_command`.
ExitCode convert_command(process::Process& process, const ConvertArguments& arguments);

/// Makes a mesh with `make`, writes it and its reports, and prints a summary: the common part of all commands
/// that make a mesh.
ExitCode make_and_write(process::Process& process, const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make);

}  // namespace collarmesh::cli
