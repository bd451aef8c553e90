#pragma once

#include <string>
#include <variant>
#include <vector>

#include "collarmesh/options.h"
#include "process/exit_code.h"
#include "report/report.h"

namespace CLI {
class App;
}

namespace collarmesh::cli {

using process::ExitCode;

/// `collarmesh INPUT... -o OUT`
struct MeshArguments : report::RequestedRun {
  std::string batch;  ///< a folder: each input is a part of its own, with a mesh there; empty: no batch
  std::string input_format, output_format;  ///< extensions with their dot; empty: those of the files
  bool tell_losses = false;                 ///< say what the output's format has no place for
};

/// `collarmesh check MESH --against INPUT...`
struct CheckArguments : RunOptions {
  std::string mesh_path;
  std::vector<std::string> inputs;
  bool json = false;
};

/// `collarmesh info INPUT...`
struct InfoArguments : RunOptions {
  std::vector<std::string> inputs;
  std::vector<double> predicted_sizes;  ///< 0: `mesh.size`, or its default; empty: nothing is predicted
  bool json = false;
};

/// `collarmesh convert IN... -o OUT`: a surface becomes a mesh if OUT is one. "-" among the inputs is
/// standard input, as output it is standard output.
struct ConvertArguments : MeshArguments {
  std::vector<std::string> meshing_options;  ///< those given that only meshing has a use for
  bool repairs = false;  ///< surfaces that become surfaces, too: --repair was given and is not none
};

/// `collarmesh repair IN... -o OUT`; "-" as in ConvertArguments. There is one report at most.
struct RepairArguments : MeshArguments {
  bool json = false;
};

/// `collarmesh remesh MESH -o OUT`
struct RemeshArguments : MeshArguments {};

using Arguments = std::variant<MeshArguments, CheckArguments, InfoArguments, ConvertArguments,
                               RepairArguments, RemeshArguments>;

/// Adds the options of meshing, all but the files, for another program that meshes; and check what one of
/// them alone cannot tell, which throws CLI::ValidationError.
void add_run_options(CLI::App& app, MeshArguments& arguments);
void check_run_arguments(const MeshArguments& arguments);

/// The extensions of everything that is read or written.
std::vector<std::string> all_formats();

/// Understand a command line. When there is nothing to run (help, version, a mistake) the text has
/// been printed and the exit code is returned instead.
std::variant<Arguments, ExitCode> parse(int argc, const char* const* argv);

}  // namespace collarmesh::cli
