#pragma once

#include <functional>
#include <memory>

#include "arguments.h"
#include "files/complex_input.h"
#include "process/process.h"
#include "report/report.h"
#include "stages.h"

namespace collarmesh::cli {

/// Reads the input, builds the complex, meshes it, certifies and writes the mesh. Throws the library's
/// exceptions.
ExitCode mesh_command(process::Process& process, const MeshArguments& arguments);

/// Makes a mesh and writes it, with reports, and prints a summary: the common part of all commands that make
/// a mesh.
ExitCode make_and_write(process::Process& process, const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make);

/// A mesh in memory, for programs that process it further.
struct MadeMesh {
  std::unique_ptr<files::ComplexInput> input;  ///< has the complex of the run, and its exact geometry
  report::MeshRun run;
  RepairOptions repair;  ///< the repair options with which that complex was built
};

/// Does everything that `mesh_command` does before it writes. Throws the library's exceptions, and Stopped.
MadeMesh make_mesh(process::Process& process, const MeshArguments& arguments);

/// Reads the input files, like `make_mesh`.
std::unique_ptr<files::ComplexInput> read_inputs(process::Process& process, const MeshArguments& arguments);

/// Prints the problems of a mesh to standard error and, unless quiet, its summary.
void tell_of(const process::Console& console, const MeshArguments& arguments, const report::MeshRun& run);

}  // namespace collarmesh::cli
