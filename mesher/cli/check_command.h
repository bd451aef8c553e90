#pragma once

#include "arguments.h"

namespace collarmesh::cli {

/// Certify a mesh file; findings and measures go to standard output.
ExitCode check_command(const CheckArguments& arguments);

}  // namespace collarmesh::cli
