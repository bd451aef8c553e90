#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Say on standard output what the complex, or the mesh, is.
ExitCode info_command(const InfoArguments& arguments);

}  // namespace collarmesh::cli
