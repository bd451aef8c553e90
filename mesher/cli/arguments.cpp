#include "arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <sstream>
#include <string_view>

#include "batch_command.h"
#include "collarmesh/error.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "command/option_values.h"
#include "command/usage_error.h"
#include "completions.h"
#include "files/cad_files.h"
#include "files/file_groups.h"
#include "files/surface_files.h"
#include "help_text.h"
#include "io/file_format.h"
#include "man_page.h"
#include "report/conversion_report.h"
#include "report/html_report.h"
#include "report/json_text.h"
#include "report/options_json.h"

namespace collarmesh::cli {

namespace {

std::string known_formats() {
  return list(files::surface_formats()) + " or " + list(io::written_tet_mesh_formats());
}

}  // namespace

std::vector<std::string> all_formats() {
  std::vector<std::string> formats = files::surface_formats();
  for (auto& more : {io::written_tet_mesh_formats(), io::read_tet_mesh_formats()})
    for (const std::string& format : more)
      if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
  for (const std::string& format : files::CadFiles::formats()) formats.push_back(format);
  return formats;
}

namespace {

std::string known_inputs() {
  std::vector<std::string> formats = files::surface_formats();
  for (const std::string& format : files::CadFiles::formats()) formats.push_back(format);
  return list(formats);
}

bool is_meshing_group(const std::string& group) {
  return group.starts_with("Size") || group == "Quality" || group == "Elements";
}

void add_format(CLI::App& app, const std::string& option, std::string& format, const std::string& help,
                const std::vector<std::string>& formats) {
  app.add_option(option, format, help)
      ->transform(format_name(formats))
      ->type_name("FORMAT")
      ->default_str("by extension");
}

void add_output_format(CLI::App& app, std::string& format, const std::string& when) {
  add_format(app, "--format", format, "Format of the output, an extension such as vtu or msh2" + when,
             all_formats());
}

void add_mesh_options(CLI::App& app, MeshArguments& a) {
  app.add_option("INPUT", a.inputs,
                 "Surfaces, complexes and CAD shapes (" + known_inputs() + "); several are one complex")
      ->type_name("FILE");
  app.add_option("-o,--output", a.output, "The mesh to write: " + list(io::written_tet_mesh_formats()))
      ->type_name("FILE");
  app.add_option(
         "--batch", a.batch,
         "In place of --output: mesh each INPUT by itself, and write its mesh, under the name of the input, "
         "into this folder; --report json and --report html write a report beside each mesh")
      ->type_name("FOLDER");
  add_output_format(app, a.output_format, "");
  add_options(app, Option::mesh, a);
}

/// Adds the arguments for the input files and the output file of `convert` and `repair`.
void add_conversion_files(CLI::App& app, MeshArguments& a, const std::string& inputs) {
  app.add_option("IN", a.inputs, inputs + "; -: standard input")->required()->type_name("FILE");
  app.add_option("-o,--output", a.output, "The file to write; -: standard output")
      ->required()
      ->type_name("FILE");
  add_output_format(app, a.output_format, "; needed for -");
  add_format(app, "--input-format", a.input_format, "Format of the inputs, an extension; needed for -",
             all_formats());
}

CLI::App* add_convert_command(CLI::App& app, MeshArguments& a) {
  CLI::App* convert = app.add_subcommand(
      "convert",
      "Convert surfaces, complexes and meshes into each other; to become a mesh, a surface is meshed");
  add_conversion_files(*convert, a, "Surfaces and complexes, joined into one, or one mesh");
  add_options(*convert, Option::convert, a);
  return convert;
}

CLI::App* add_remesh_command(CLI::App& app, RemeshArguments& a) {
  CLI::App* remesh = app.add_subcommand(
      "remesh",
      "Adapt a mesh to sizes, finer or coarser; keeps its regions, surfaces, edges, names and numbers");
  remesh->add_option("MESH", a.inputs, "The mesh: " + list(io::read_tet_mesh_formats()))
      ->required()
      ->expected(1)
      ->type_name("FILE");
  remesh
      ->add_option("--against", a.against,
                   "The input that the mesh was made from, one or several files; the result follows this "
                   "input, and the exact faces of CAD files")
      ->type_name("FILE");
  remesh->add_option("-o,--output", a.output, "The mesh to write: " + list(io::written_tet_mesh_formats()))
      ->type_name("FILE");
  add_output_format(*remesh, a.output_format, "");
  add_format(*remesh, "--input-format", a.input_format, "Format of the mesh, an extension",
             io::read_tet_mesh_formats());
  add_options(*remesh, Option::remesh, a);
  return remesh;
}

CLI::App* add_check_command(CLI::App& app, CheckArguments& a) {
  CLI::App* check = app.add_subcommand("check", "Certify a mesh against the input it was made from");
  check->add_option("MESH", a.mesh_path, "The mesh: " + list(io::read_tet_mesh_formats()))
      ->required()
      ->type_name("FILE");
  check->add_option("--against", a.inputs, "The input: one or several files")->required()->type_name("FILE");
  add_options(*check, Option::check, a);
  check->add_flag("--json", a.json, "Print JSON");
  return check;
}

CLI::App* add_info_command(CLI::App& app, InfoArguments& a) {
  CLI::App* info = app.add_subcommand("info", "Describe the input: features, regions, creases, angles");
  info->add_option("INPUT", a.inputs, "Files of one complex, or one mesh")->required()->type_name("FILE");
  info->add_flag("--json", a.json, "Print JSON");
  CLI::Option* const predict =
      info->add_option(
              "--predict", a.predicted_sizes,
              "Estimate how many tetrahedra meshes of these sizes have and how many seconds they take, "
              "without making the meshes; 0: the default size")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(number_in(0, 1e300, "a length >= 0 in input units"))
          ->type_name("LENGTH,...");
  add_options(*info, Option::info, a);
  for (CLI::Option* option : info->get_options())
    if (is_meshing_group(option->get_group())) option->needs(predict);
  return info;
}

CLI::App* add_repair_command(CLI::App& app, RepairArguments& a) {
  CLI::App* repair = app.add_subcommand(
      "repair", "Write the facets that would be meshed: repaired if they do not form a valid complex");
  add_conversion_files(*repair, a, "Surfaces, complexes and CAD shapes, joined into one");
  add_options(*repair, Option::repair, a);
  repair->add_option("--report", a.reports, "Write the repairs as JSON")->type_name("FILE")->expected(1);
  repair->add_flag("--json", a.json, "Print the repairs as JSON");
  return repair;
}

/// Returns the end of a message about an output path without a known format: the path's extension, or the
/// library that the format needs but the program lacks.
std::string extension_list(const std::string& path) {
  if (const std::string missing = io::missing_library(path); !missing.empty())
    return "cannot be written: " + missing;
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension.empty() ? "has no extension" : fmt::format("ends in '{}'", extension);
}

std::string format_of_output(const MeshArguments& a) { return io::format_of(a.output, a.output_format); }

bool output_is_among(const std::vector<std::string>& formats, const MeshArguments& a) {
  return std::find(formats.begin(), formats.end(), format_of_output(a)) != formats.end();
}

/// Rejects partitions if the output format cannot store them, and options that need partitions if the mesh
/// has none. `from_mesh`: the input is a mesh, which may be partitioned already.
void check_partitions(const MeshArguments& a, bool from_mesh) {
  if (a.partitions > 0 && !output_is_among(io::formats_with_partitions(), a))
    reject("--partitions", "{} has no place for partitions; use {}", format_of_output(a),
           list(io::formats_with_partitions()));
  if (!a.cell_decomposition.empty() && !io::is_tet_mesh_format(a.output, a.output_format))
    reject("--cell-decomposition", "needs a mesh, but the output is a surface");
  if (!a.cell_decomposition.empty() && a.partitions == 0 && !from_mesh)
    reject("--cell-decomposition", "needs partitions; say how many with --partitions");
  if (a.ghost_cells == GhostCells::off) return;
  if (!output_is_among(io::formats_with_ghost_cells(), a))
    reject("--ghost-cells", "{} has no place for ghost cells; use {}", format_of_output(a),
           list(io::formats_with_ghost_cells()));
  if (a.partitions == 0 && !from_mesh)
    reject("--ghost-cells", "needs partitions; say how many with --partitions");
}

/// Checks the arguments for one mesh or for a batch; the parts of a batch are checked as if each were alone.
void check_mesh_arguments(const MeshArguments& a);

void check_batch(const MeshArguments& a) {
  if (!a.output.empty()) reject("--batch", "contradicts --output; use one of them");
  if (!a.cell_decomposition.empty())
    reject("--batch", "makes several meshes, so leave out --cell-decomposition, which is for one");
  if (!a.trace_folder.empty())
    reject("--batch", "makes several meshes, so leave out --trace, which is for one");
  if (a.output_format == ".polymesh")
    reject("--format", "polymesh needs a folder for each mesh; mesh the parts one by one");
  for (const std::string& report : a.reports)
    if (report != "json" && report != "html")
      reject("--report", "'{}' must be json or html with --batch", report);
  if (const std::string both = parts_of_one_name(a); !both.empty())
    reject("--batch", "would give the meshes of {} the same name; rename one of them", both);
  for (const std::string& input : a.inputs) check_mesh_arguments(part_of_batch(a, input));
}

void check_output_of_lines(const MeshArguments& a) {
  if (!output_is_among(io::formats_of_surfaces(), a))
    reject("--output", "'{}' {} no place for lines alone; use {}", a.output,
           io::is_tet_mesh_format(a.output, a.output_format) ? "has" : "is of a format that has",
           list(io::formats_of_surfaces()));
}

void check_output_of_surfaces(const MeshArguments& a) {
  const bool is_surface = files::is_surface_format(a.output, a.output_format);
  if (!is_surface && !output_is_among(io::formats_of_surfaces(), a))
    reject("--output", "'{}' {} no place for triangles alone; use {} or {}", a.output,
           io::is_tet_mesh_format(a.output, a.output_format) ? "has" : "is of a format that has",
           list(io::formats_of_surfaces()), list(files::surface_formats()));
  if (a.triangle_elements != TriangleElements::shell && format_of_output(a) != ".inp")
    reject("--triangle-elements", "'{}' cannot store types of elements; use .inp", a.output);
  if (is_surface && a.order == 2)
    reject("--order", "{} has no elements of second order; use --order 1", format_of_output(a));
}

/// Rejects layers of prisms, before anything is meshed, if the output format cannot hold them.
void check_output_of_layers(const MeshArguments& a) {
  const std::vector<std::string> formats = io::formats_with_layers(a.order);
  if (!a.layers.any() || a.layers.tets || !io::is_tet_mesh_format(a.output, a.output_format) ||
      output_is_among(formats, a))
    return;
  reject("--layers", "'{}' has no place for prisms{}; use {}, or add --layers-tets", a.output,
         a.order == 2 ? " of second order" : "", list(formats));
}

void check_mesh_arguments(const MeshArguments& a) {
  if (a.inputs.empty()) throw CLI::RequiredError("INPUT, a file to mesh,");
  if (!a.batch.empty()) {
    check_batch(a);
    return;
  }
  if (a.output.empty()) throw CLI::RequiredError("--output, the mesh to write,");
  if (a.output == "-")
    reject(
        "--output",
        "- is standard output, which is for convert and repair: collarmesh convert IN... -o - --format vtu");
  if (a.dimension == 1) {
    check_output_of_lines(a);
  } else if (a.dimension == 2) {
    check_output_of_surfaces(a);
  } else if (!io::is_tet_mesh_format(a.output, a.output_format)) {
    reject("--output", "'{}' {}; use {}", a.output, extension_list(a.output),
           list(io::written_tet_mesh_formats()));
  }
  check_output_of_layers(a);
  if (a.order == 2 && output_is_among(io::formats_of_first_order(), a))
    reject("--order", "{} has no elements of second order; use --order 1", format_of_output(a));
  check_partitions(a, false);
  check_run_arguments(a);
}

void check_standard_input(const MeshArguments& a) {
  const auto dashes = std::count(a.inputs.begin(), a.inputs.end(), "-");
  if (dashes > 1) reject("IN", "standard input (-) can be read once only");
  if (dashes > 0 && a.input_format.empty()) reject("--input-format", "is needed for standard input (-)");
}

void check_repair_arguments(const RepairArguments& a) {
  if (!files::is_surface_format(a.output, a.output_format))
    reject("--output", "'{}' {}; use {}, or name one with --format", a.output, extension_list(a.output),
           list(files::surface_formats()));
  if (a.output == "-" && a.json)
    reject("--json", "cannot print to standard output, where the file goes; use --report");
  if (!a.reports.empty() && report::is_html(a.reports.front()))
    reject("--report", "is JSON here; only meshes have pages (.html)");
  check_standard_input(a);
  check_outputs(a);
}

void check_convert_arguments(const MeshArguments& a) {
  if (a.output_format.empty() && !files::is_surface_format(a.output) && !io::is_tet_mesh_format(a.output))
    reject("--output", "'{}' {}; use {}, or name one with --format", a.output, extension_list(a.output),
           known_formats());
  check_standard_input(a);
  check_output_of_layers(a);
  check_partitions(a, io::is_tet_mesh_format(a.inputs.front(), a.input_format));
  if (a.output == "-" && files::is_of_several_files(a.output_format))
    reject("--format", "writes several files, so the output cannot be standard output");
  check_run_arguments(a);
}

constexpr const char* footer =
    "Exit codes: 0 every guarantee holds, 1 internal error, 2 usage, 3 unreadable\n"
    "input, 4 not a valid complex, 5 a budget was hit, 6 cancelled, 7 a guarantee is\n"
    "missed (the mesh is written), 8 cannot write. 1 to 6 and 8 write no mesh.\n"
    "Lengths are in input units (millimetres for CAD files); 'diagonal' is the\n"
    "bounding box's.";

}  // namespace

std::variant<Arguments, ExitCode> parse(const process::Console& console, int argc, const char* const* argv) {
  MeshArguments mesh;
  CheckArguments check;
  InfoArguments info;
  ConvertArguments convert;
  RepairArguments repair;
  RemeshArguments remesh;
  CLI::App app("collarmesh: tetrahedral meshes of piecewise-linear complexes, certified", "collarmesh");
  app.set_version_flag("--version", "collarmesh " COLLARMESH_VERSION);
  app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
  app.formatter(std::make_shared<HelpText>());
  app.footer(footer);
  app.require_subcommand(0, 1);
  add_mesh_options(app, mesh);
  CLI::App* const remesh_command = add_remesh_command(app, remesh);
  CLI::App* const check_command = add_check_command(app, check);
  CLI::App* const info_command = add_info_command(app, info);
  CLI::App* const convert_command = add_convert_command(app, convert);
  CLI::App* const repair_command = add_repair_command(app, repair);
  if (argc == 3 && argv[1] == std::string_view("--generate")) {  // used by the build, not by users
    const std::string_view kind = argv[2];
    fmt::print("{}", kind == "man"       ? man_page(app, COLLARMESH_VERSION, footer)
                     : kind == "options" ? report::json_text(report::option_table_json(), 1) + '\n'
                                         : completion(app, kind));
    return ExitCode::success;
  }
  if (const std::string mistaken = argc > 1 ? mistaken_command(argv[1]) : ""; !mistaken.empty()) {
    fmt::print(stderr, "collarmesh: {}\nRun with --help for more information.\n", mistaken);
    return ExitCode::usage;
  }
  try {
    app.parse(argc, argv);
    const bool subcommand = !app.get_subcommands().empty();
    if (!subcommand) check_mesh_arguments(mesh);
    if (convert_command->parsed()) {
      check_convert_arguments(convert);
      convert.repairs =
          convert_command->get_option("--repair")->count() > 0 && convert.repair.mode != RepairMode::off;
      for (const CLI::Option* option : convert_command->get_options())
        if (option->count() > 0 && is_meshing_group(option->get_group()))
          convert.meshing_options.push_back(option->get_name());
    }
    if (repair_command->parsed()) check_repair_arguments(repair);
    if (remesh_command->parsed()) check_mesh_arguments(remesh);
    for (RunOptions* const options : std::initializer_list<RunOptions*>{&mesh, &check, &convert})
      *options = with_profile(*options);
    if (subcommand && (!mesh.inputs.empty() || !mesh.output.empty())) throw CLI::HorribleError("");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // for --help and --version
      std::ostringstream text, nothing;
      app.exit(error, text, nothing);
      console.print_result(text.str());
      return ExitCode::success;
    }
    const bool subcommand_last =
        !app.get_subcommands().empty() && (!mesh.inputs.empty() || !mesh.output.empty());
    console.tell("collarmesh: {}\nRun with --help for more information.\n",
                 subcommand_last ? "a subcommand comes first: collarmesh check MESH ..., info INPUT ..., "
                                   "convert IN ..., repair IN ..., remesh MESH ..."
                                 : usage_message(app, error));
    return ExitCode::usage;
  }
  if (check_command->parsed()) return Arguments(check);
  if (info_command->parsed()) return Arguments(info);
  if (repair_command->parsed()) return Arguments(repair);
  if (remesh_command->parsed()) return Arguments(remesh);
  if (convert_command->parsed()) {
    convert.tell_losses = true;
    return Arguments(convert);
  }
  return Arguments(mesh);
}

}  // namespace collarmesh::cli
