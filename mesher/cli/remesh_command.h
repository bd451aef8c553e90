#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Reads a mesh, adapt it to sizes, certify it, write it. Throws what the library throws.
ExitCode remesh_command(const RemeshArguments& arguments);

}  // namespace collarmesh::cli
