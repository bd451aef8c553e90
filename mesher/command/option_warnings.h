#pragma once

#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "command/mesh_arguments.h"

namespace collarmesh::command {

/// Returns warnings of options whose values are beyond those that are proved or known to work: for each a
/// full sentence, with an alternative.
std::vector<std::string> option_warnings(const MeshArguments& arguments, const Plc& plc);

}  // namespace collarmesh::command
