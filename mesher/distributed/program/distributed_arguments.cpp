#include "distributed_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <sstream>

#include "command/option_values.h"
#include "command/usage_error.h"
#include "report/html_report.h"

namespace collarmesh::distributed {

namespace {

constexpr const char* footer =
    "Exit codes: 0 every guarantee holds, 1 internal error, 2 usage, 3 unreadable input,\n"
    "4 not a valid complex, 5 a budget was hit, 6 cancelled,\n"
    "7 a guarantee is missed (the mesh is written), 8 cannot write. 1 to 6 and 8 write no mesh.\n"
    "PETSc's own options are taken from the environment variable PETSC_OPTIONS.";

std::string extension_of(const std::string& path) { return std::filesystem::path(path).extension().string(); }

void check(const DistributedArguments& a) {
  if (a.mesh.inputs.empty()) throw CLI::RequiredError("INPUT, a file to mesh,");
  if (a.mesh.output.empty()) throw CLI::RequiredError("--output, the mesh to write,");
  if (const std::string extension = extension_of(a.mesh.output); extension != ".h5" && extension != ".pvtu")
    throw CLI::ValidationError("--output",
                               fmt::format("'{}' ends in '{}'; use .h5 or .pvtu", a.mesh.output, extension));
  for (const std::string& report : a.mesh.reports)
    if (report::is_html(report))
      throw CLI::ValidationError("--report", "is JSON here; pages (.html) are made by collarmesh");
  if (a.mesh.reports.size() > 1) throw CLI::ValidationError("--report", "is given twice; use it once");
  if (a.mesh.partitions > 0 || !a.mesh.cell_decomposition.empty())
    throw CLI::ValidationError("--partitions", "is for collarmesh; here each rank has a part of its own");
  command::check_run_arguments(a.mesh);
}

}  // namespace

bool writes_pieces(const DistributedArguments& arguments) {
  return extension_of(arguments.mesh.output) == ".pvtu";
}

std::variant<DistributedArguments, process::ExitCode> parse(const process::Console& console, int argc,
                                                            const char* const* argv) {
  DistributedArguments arguments;
  CLI::App app(
      "collarmesh-mpi: a certified coarse mesh, distributed, refined and projected onto its shape on all "
      "ranks",
      "collarmesh-mpi");
  app.set_version_flag("--version", "collarmesh-mpi " COLLARMESH_VERSION);
  app.footer(footer);
  app.add_option("INPUT", arguments.mesh.inputs,
                 "Surfaces, complexes and CAD shapes; several are one complex")
      ->type_name("FILE");
  app.add_option(
         "-o,--output", arguments.mesh.output,
         "The mesh to write: .h5 (PETSc's DMPlex, with .xdmf beside it) or .pvtu (with a piece of each rank)")
      ->type_name("FILE");
  app.add_option("--levels", arguments.levels, "Number of times that every tetrahedron is cut into eight")
      ->check(command::number_in(0, 12, "a number of levels from 0 to 12"))
      ->check(command::whole_number())
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--slack", arguments.slack,
                 "Degrees by which dihedral angles may go beyond those of the coarse mesh")
      ->check(command::number_in(0, 180, "an angle from 0 to 180 degrees"))
      ->capture_default_str()
      ->type_name("DEGREES");
  command::add_options(app, Option::mesh, arguments.mesh);
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
