#include "distributed_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <sstream>

#include "command/usage_error.h"
#include "report/html_report.h"

namespace collarmesh::distributed {

namespace {

constexpr const char* footer =
    "Exit codes: 0 every guarantee holds, 1 internal error, 2 usage, 3 unreadable input,\n"
    "4 not a valid complex, 5 a budget was hit, 6 cancelled,\n"
    "7 a guarantee is missed, 8 cannot write. Only 0 and 7 write the mesh.\n"
    "PETSc's own options are taken from the environment variable PETSC_OPTIONS.";

std::string extension_of(const std::string& path) { return std::filesystem::path(path).extension().string(); }

void check(const command::MeshArguments& a) {
  if (a.inputs.empty()) throw CLI::RequiredError("INPUT, a file to mesh,");
  if (a.output.empty()) throw CLI::RequiredError("--output, the mesh to write,");
  if (const std::string extension = extension_of(a.output); extension != ".h5" && extension != ".pvtu")
    throw CLI::ValidationError("--output",
                               fmt::format("'{}' ends in '{}'; use .h5 or .pvtu", a.output, extension));
  for (const std::string& report : a.reports)
    if (report::is_html(report))
      throw CLI::ValidationError("--report", "is JSON here; pages (.html) are made by collarmesh");
  if (a.reports.size() > 1) throw CLI::ValidationError("--report", "is given twice; use it once");
  if (a.partitions > 0 || !a.cell_decomposition.empty())
    throw CLI::ValidationError("--partitions", "is for collarmesh; here each rank has a part of its own");
  command::check_run_arguments(a);
}

}  // namespace

bool writes_pieces(const command::MeshArguments& arguments) {
  return extension_of(arguments.output) == ".pvtu";
}

std::variant<command::MeshArguments, process::ExitCode> parse(const process::Console& console, int argc,
                                                              const char* const* argv) {
  command::MeshArguments arguments;
  CLI::App app(
      "collarmesh-mpi: a certified coarse mesh, distributed, refined and projected onto its shape on all "
      "ranks",
      "collarmesh-mpi");
  app.set_version_flag("--version", "collarmesh-mpi " COLLARMESH_VERSION);
  app.footer(footer);
  app.add_option("INPUT", arguments.inputs, "Surfaces, complexes and CAD shapes; several are one complex")
      ->type_name("FILE");
  app.add_option(
         "-o,--output", arguments.output,
         "The mesh to write: .h5 (PETSc's DMPlex, with .xdmf beside it) or .pvtu (with a piece of each rank)")
      ->type_name("FILE");
  command::add_options(app, Option::ranks, arguments);
  command::add_options(app, Option::mesh, arguments);
  try {
    app.parse(argc, argv);
    check(arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // for --help and --version
      std::ostringstream text, nothing;
      app.exit(error, text, nothing);
      console.print_result(text.str());
      return process::ExitCode::success;
    }
    console.tell("collarmesh-mpi: {}\nRun with --help for more information.\n",
                 command::usage_message(app, error));
    return process::ExitCode::usage;
  }
  return arguments;
}

}  // namespace collarmesh::distributed
