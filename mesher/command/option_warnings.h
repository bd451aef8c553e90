#pragma once

#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "command/mesh_arguments.h"

namespace collarmesh::command {

/// Returns warnings about options that have no effect, or whose values are beyond those that are proved or
/// known to work. Each is a full sentence.
std::vector<std::string> option_warnings(const MeshArguments& arguments, const Plc& plc);

}  // namespace collarmesh::command
