#pragma once

#include <memory>
#include <string>

#include "command/mesh_arguments.h"
#include "command/stages.h"
#include "files/complex_input.h"
#include "process/process.h"
#include "report/report.h"

namespace collarmesh::command {

/// A mesh in memory, for programs that process it further.
struct MadeMesh {
  std::unique_ptr<files::ComplexInput> input;  ///< has the complex of the run, and its exact geometry
  report::MeshRun run;
  RepairOptions repair;  ///< the repair options with which the complex was built
};

/// Reads the input, builds the complex, meshes it and certifies the mesh. Throws the library's exceptions,
/// and Stopped.
MadeMesh make_mesh(process::Process& process, const MeshArguments& arguments);

/// Reads the input files, interruptibly. Throws the library's exceptions, and Stopped.
std::unique_ptr<files::ComplexInput> read_inputs(process::Process& process, const MeshArguments& arguments);

/// Meshes `input` and puts the results into `run`. Returns the options with which the complex was repaired.
RepairOptions make_mesh(process::Process& process, const MeshArguments& arguments, files::ComplexInput& input,
                        Stages& stages, report::MeshRun& run);

/// Writes the trace to a staged file, which appears when it is committed. Returns null without --trace, and
/// for an empty trace.
std::unique_ptr<process::StagedFile> staged_trace(process::Process& process, const MeshArguments& arguments,
                                                  const Trace& trace);

/// Puts the file's name before each line that lacks it, because a quiet run prints it nowhere else.
std::string each_line_of(const std::string& file, const std::string& text);

}  // namespace collarmesh::command
