#pragma once

#include <variant>

#include "arguments.h"

namespace collarmesh::distributed {

struct DistributedArguments {
  cli::MeshArguments mesh;  ///< options of the coarse mesh, with the files; its order is that of the finest
                            ///< one
  unsigned levels = 1;
  double slack = 10;  ///< degrees by which angles may exceed those of the coarse mesh
};

/// Parses a command line. If there is nothing to run (help, version, a mistake), prints the text and returns
/// the exit code instead.
std::variant<DistributedArguments, process::ExitCode> parse(int argc, const char* const* argv);

/// Returns whether to write .pvtu and pieces; otherwise .h5.
bool writes_pieces(const DistributedArguments& arguments);

}  // namespace collarmesh::distributed
