#pragma once

#include <string>
#include <vector>

#include "arguments.h"
#include "collarmesh/plc.h"

namespace collarmesh::cli {

/// Options that go further than what is proved or was seen to end: a full sentence each, with what to
/// do instead.
std::vector<std::string> option_warnings(const MeshArguments& arguments, const Plc& plc);

}  // namespace collarmesh::cli
