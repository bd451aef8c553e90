#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Read, build the complex, mesh, certify, write. Throws what the library throws.
ExitCode mesh_command(const MeshArguments& arguments);

}  // namespace collarmesh::cli
