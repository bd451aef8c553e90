#pragma once

#include <variant>

#include "arguments.h"

namespace collarmesh::distributed {

struct DistributedArguments {
  cli::MeshArguments mesh;  ///< of the coarse mesh, with the files; its order is that of the finest one
  unsigned levels = 1;
  double slack = 10;  ///< degrees that angles may exceed those of the coarse mesh by
};

/// Understand a command line. When there is nothing to run (help, version, a mistake) the text has been
/// printed and the exit code is returned instead.
std::variant<DistributedArguments, process::ExitCode> parse(int argc, const char* const* argv);

/// Is it .pvtu and pieces that are to be written? Else it is .h5.
bool writes_pieces(const DistributedArguments& arguments);

}  // namespace collarmesh::distributed
