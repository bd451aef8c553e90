#pragma once

#include <string>

#include "collarmesh/options.h"
#include "report/report.h"

namespace CLI {
class App;
}

namespace collarmesh::command {

/// The arguments of a command that makes a mesh, `collarmesh INPUT... -o OUT`.
struct MeshArguments : report::RequestedRun {
  std::string batch;  ///< a folder for meshes: each input is meshed as a separate part; empty: no batch
  std::string input_format, output_format;  ///< extensions with their dot; empty: the files' own
  bool tell_losses = false;                 ///< report data that the output's format cannot store
};

/// Adds those options of the table that this command takes.
void add_options(CLI::App& app, Option::Command command, RunOptions& options);

/// Checks combinations of options. Throws CLI::ValidationError.
void check_run_arguments(const MeshArguments& arguments);

/// Checks that no output replaces an input or another output; `check_run_arguments` does that, too.
void check_outputs(const MeshArguments& arguments);

}  // namespace collarmesh::command
