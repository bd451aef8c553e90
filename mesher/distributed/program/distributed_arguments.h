#pragma once

#include <variant>

#include "command/mesh_arguments.h"
#include "process/console.h"
#include "process/exit_code.h"

namespace collarmesh::distributed {

struct DistributedArguments {
  command::MeshArguments mesh;  ///< options of the coarse mesh, with the files; the order is that of the
                                ///< finest mesh
  unsigned levels = 1;
  double slack = 10;  ///< degrees by which angles may be worse than those of the coarse mesh
};

/// Parses a command line. If there is nothing to run (help, version, a mistake), prints the text and returns
/// the exit code instead.
std::variant<DistributedArguments, process::ExitCode> parse(const process::Console& console, int argc,
                                                            const char* const* argv);

/// Returns whether to write a .pvtu with pieces; otherwise an .h5 is written.
bool writes_pieces(const DistributedArguments& arguments);

}  // namespace collarmesh::distributed
