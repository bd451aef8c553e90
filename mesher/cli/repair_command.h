#pragma once

#include "arguments.h"
#include "process/process.h"

namespace collarmesh::cli {

/// Writes the facets that the mesher would use: repaired, or unchanged if they are a valid complex. Throws
/// PlcError if they cannot be repaired.
ExitCode repair_command(process::Process& process, const RepairArguments& arguments);

}  // namespace collarmesh::cli
