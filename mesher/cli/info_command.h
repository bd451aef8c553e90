#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Describes the complex, or the mesh, on standard output.
ExitCode info_command(const InfoArguments& arguments);

}  // namespace collarmesh::cli
