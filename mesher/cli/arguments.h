#pragma once

#include <string>
#include <variant>
#include <vector>

#include "collarmesh/options.h"
#include "command/mesh_arguments.h"
#include "process/console.h"
#include "process/exit_code.h"

namespace collarmesh::cli {

using namespace command;  // the code shared with collarmesh-mpi
using process::ExitCode;

/// The arguments of `collarmesh check MESH --against INPUT...`.
struct CheckArguments : RunOptions {
  std::string mesh_path;
  std::vector<std::string> inputs;
  bool json = false;
};

/// The arguments of `collarmesh info INPUT...`.
struct InfoArguments : RunOptions {
  std::vector<std::string> inputs;
  std::vector<double> predicted_sizes;  ///< target edge lengths of meshes to predict; 0: `mesh.size`, or its
                                        ///< default; empty: no prediction
  bool json = false;
};

/// The arguments of `collarmesh convert IN... -o OUT`: a surface is meshed if OUT has a format of meshes. "-"
/// is standard input or standard output.
struct ConvertArguments : MeshArguments {
  std::vector<std::string> meshing_options;  ///< names of given options that only meshing uses
  bool repairs = false;  ///< whether to repair surfaces that are converted to surfaces: --repair is given
                         ///< with a value other than none
};

/// The arguments of `collarmesh repair IN... -o OUT`; "-" as in ConvertArguments. `reports` has at most one
/// entry.
struct RepairArguments : MeshArguments {
  bool json = false;
};

/// The arguments of `collarmesh remesh MESH -o OUT`.
struct RemeshArguments : MeshArguments {
  std::vector<std::string> against;  ///< files that the mesh was made from; empty: use the mesh's surface
};

using Arguments = std::variant<MeshArguments, CheckArguments, InfoArguments, ConvertArguments,
                               RepairArguments, RemeshArguments>;

/// Returns the extensions of all formats that are read or written.
std::vector<std::string> all_formats();

/// Parses a command line. If there is nothing to run (help, version, a mistake), prints the text and returns
/// an exit code, not arguments.
std::variant<Arguments, ExitCode> parse(const process::Console& console, int argc, const char* const* argv);

}  // namespace collarmesh::cli
