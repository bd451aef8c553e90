#pragma once

#include <functional>
#include <string>
#include <vector>

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Returns the arguments that mesh one file of a batch. The mesh and reports go to the batch's folder.
MeshArguments part_of_batch(const MeshArguments& batch, const std::string& input);

/// Returns two parts whose meshes would have the same name, as in "a/x.stl and b/x.off"; empty if there are
/// none.
std::string parts_of_one_name(const MeshArguments& batch);

/// Meshes each input separately, in a process of its own, and prints a table of the results. Returns
/// ExitCode::cancelled if the user asked to stop; else the first code that is neither success nor
/// guarantee_missed; else guarantee_missed if a part returned it. `run` meshes a part as if it were alone.
ExitCode batch_command(process::Process& process, const MeshArguments& batch,
                       const std::function<ExitCode(const MeshArguments& part)>& run);

}  // namespace collarmesh::cli
