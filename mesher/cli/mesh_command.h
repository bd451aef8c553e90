#pragma once

#include <functional>
#include <memory>

#include "arguments.h"
#include "files/complex_input.h"
#include "report/report.h"
#include "stages.h"

namespace collarmesh::cli {

/// Read, build the complex, mesh, certify, write. Throws what the library throws.
ExitCode mesh_command(const MeshArguments& arguments);

/// Has a mesh made and written, with reports, and says what it is like: what all commands have in common that
/// make one.
ExitCode make_and_write(const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make);

/// A mesh in memory, for programs that go on with it.
struct MadeMesh {
  std::unique_ptr<files::ComplexInput> input;  ///< has the complex of the run, and its exact geometry
  report::MeshRun run;
  RepairOptions repair;  ///< with these that complex was built
};

/// What `mesh_command` does before it writes. Throws what the library throws, and Stopped.
MadeMesh make_mesh(const MeshArguments& arguments);

/// The files of the input as `make_mesh` reads them.
std::unique_ptr<files::ComplexInput> read_inputs(const MeshArguments& arguments);

/// On standard error: what is wrong with a mesh, then, unless it is to be quiet, what it is like.
void tell_of(const MeshArguments& arguments, const report::MeshRun& run);

}  // namespace collarmesh::cli
