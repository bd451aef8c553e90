#pragma once

#include <variant>

#include "command/mesh_arguments.h"
#include "process/console.h"
#include "process/exit_code.h"

namespace collarmesh::distributed {

/// Parses a command line. The options are those of the coarse mesh; the order is that of the finest mesh. If
/// there is nothing to run (help, version, a mistake), prints the text and returns an exit code.
std::variant<command::MeshArguments, process::ExitCode> parse(const process::Console& console, int argc,
                                                              const char* const* argv);

/// Returns whether to write a .pvtu with pieces, not an .h5.
bool writes_pieces(const command::MeshArguments& arguments);

}  // namespace collarmesh::distributed
