#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Certifies a mesh file; prints findings and measures to standard output.
ExitCode check_command(const CheckArguments& arguments);

}  // namespace collarmesh::cli
