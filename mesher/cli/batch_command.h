#pragma once

#include <functional>
#include <string>
#include <vector>

#include "arguments.h"

namespace collarmesh::cli {

/// The mesh, and the reports, that a part of a batch gets in its folder.
MeshArguments part_of_batch(const MeshArguments& batch, const std::string& input);

/// Two parts that would have one mesh, as "a/x.stl and b/x.off"; empty: there are none.
std::string parts_of_one_name(const MeshArguments& batch);

/// Meshes each input on its own, in a process of its own, and print a table of the results. Returns
/// ExitCode::cancelled if the user asked to stop, else the code of the first part without a mesh, else
/// ExitCode::guarantee_missed if that was said of one. `run` does what the program does with one part.
ExitCode batch_command(const MeshArguments& batch,
                       const std::function<ExitCode(const MeshArguments& part)>& run);

}  // namespace collarmesh::cli
