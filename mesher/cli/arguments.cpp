#include "arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "cad_files.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "completions.h"
#include "console.h"
#include "conversion_report.h"
#include "file_groups.h"
#include "html_report.h"
#include "machine.h"
#include "option_table.h"
#include "option_values.h"
#include "surface_files.h"
#include "usage_error.h"

namespace collarmesh::cli {

namespace {

std::string known_formats() {
  return list(surface_formats()) + " or " + list(io::written_tet_mesh_formats());
}

std::vector<std::string> all_formats() {
  std::vector<std::string> formats = surface_formats();
  for (auto& more : {io::written_tet_mesh_formats(), io::read_tet_mesh_formats()})
    for (const std::string& format : more)
      if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
  for (const std::string& format : CadFiles::formats()) formats.push_back(format);
  return formats;
}

std::string known_inputs() {
  std::vector<std::string> formats = surface_formats();
  for (const std::string& format : CadFiles::formats()) formats.push_back(format);
  return list(formats);
}

const CLI::Validator length = number_in(0, 1e300, "a length (a number >= 0 in input units)");
const CLI::Validator fraction = number_in(0, 0.1, "a number from 0 to 0.1 (relative to the diagonal)");
const CLI::Validator small_fraction =
    number_in(0, 0.01, "a number from 0 to 0.01 (relative to the diagonal)");
const CLI::Validator angle = number_in(0, 180, "an angle from 0 to 180 degrees");
const std::string size_group = "Size (target edge lengths, absolute, input units)";
const std::string quality_group = "Quality";
const std::string elements_group = "Elements";
const std::string partitions_group = "Partitions (for programs that run on many ranks)";

const CLI::Validator collar_angle = number_in(100, 175, "an angle from 100 to 175 degrees");
const CLI::Validator thin_angle = number_in(0.1, 30, "an angle from 0.1 to 30 degrees");
const CLI::Validator ratio = number_in(1, 1e300, "a ratio of at least 1");
const CLI::Validator number = number_in(0, 1e300, "a number >= 0");
const CLI::Validator seconds = number_in(0, 1e300, "a number of seconds >= 0");
const CLI::Validator count = whole_number();

/// An option by its name and what its value is called, "--size LENGTH". Its value 0 may stand for a
/// default that depends on the input.
template <class T>
CLI::Option* add(CLI::App& app, const std::string& name_and_type, T& value, const std::string& text,
                 const std::string& default_text = {}) {
  const std::size_t space = name_and_type.find(' ');
  CLI::Option* option = app.add_option(name_and_type.substr(0, space), value, text);
  option->type_name(name_and_type.substr(space + 1));
  if (default_text.empty()) return option->capture_default_str();
  return option->default_str(default_text);
}

CLI::Option* add_tag_values(CLI::App& app, const std::string& name, std::map<Tag, double>& sizes,
                            const std::string& text) {
  const auto store = [&sizes, name](const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      try {
        sizes.insert_or_assign(parse_tag_value(value).first, parse_tag_value(value).second);
      } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError(name, error.what());
      }
    }
  };
  return app.add_option_function<std::vector<std::string>>(name, store, text)
      ->type_name("TAG=LENGTH")
      ->allow_extra_args(false);
}

void add_complex_options(CLI::App& app, ComplexArguments& a) {
  const std::string group = "The complex";
  add(app, "--feature-angle DEGREES", a.plc.feature_angle,
      "Edges that deviate more than this from flat are segments, degrees; 0: every edge that is not flat")
      ->check(angle)
      ->group(group);
  add(app, "--planar-tolerance T", a.plc.planar_tolerance,
      "Facets within this of one plane are one, relative to the diagonal; 0: exactly coplanar ones only")
      ->check(small_fraction)
      ->group(group);
  add(app, "--weld T", a.plc.weld, "Points closer than this are one, relative to the diagonal")
      ->check(fraction)
      ->group(group);
  const std::map<std::string, RepairMode> modes{
      {"auto", RepairMode::automatic}, {"none", RepairMode::off}, {"wrap", RepairMode::wrap}};
  app.add_option(
         "--repair", a.repair.mode,
         "Facets that are no valid complex: auto repairs them, none makes them an error, wrap also puts a "
         "closed surface around what cannot be repaired, or meshed afterwards")
      ->transform(CLI::CheckedTransformer(modes).description(""))
      ->default_str("auto")
      ->type_name("auto|none|wrap")
      ->group(group);
  add(app, "--repair-tolerance T", a.repair.tolerance,
      "Features below this are noise to the repair, relative to the diagonal")
      ->check(small_fraction)
      ->group(group);
  add(app, "--wrap-offset T", a.repair.wrap_offset,
      "Of the surface that --repair wrap puts around everything, relative to the diagonal")
      ->check(number_in(1e-4, 0.1, "a number from 1e-4 to 0.1 (relative to the diagonal)"))
      ->group(group);
  const std::map<std::string, SolidOverlap> overlaps{{"first", SolidOverlap::first},
                                                     {"region", SolidOverlap::region}};
  app.add_option(
         "--overlap", a.overlap,
         "What solids of a CAD file have in common: first gives it to the first one, region makes it a "
         "region of its own")
      ->transform(CLI::CheckedTransformer(overlaps).description(""))
      ->default_str("first")
      ->type_name("first|region")
      ->group(group);
  app.add_option(
         "--names", a.names,
         "Names of patches, curves and regions, by number or by a point on them, for formats with names")
      ->type_name("FILE.json")
      ->group(group);
  add(app, "--crease-angle DEGREES", a.crease_angle,
      "Features that meet below this angle form a crease, degrees")
      ->check(number_in(0, 90, "an angle from 0 to 90 degrees"))
      ->group(group);
}

void add_size_options(CLI::App& app, MeshOptions& m, std::string& size_field) {
  const std::string& group = size_group;
  add(app, "--size LENGTH", m.size, "Everywhere", "1/20 of the diagonal")->check(length)->group(group);
  add(app, "--size-min LENGTH", m.size_min, "Never ask for less than this", "none")
      ->check(length)
      ->group(group);
  add_tag_values(app, "--region-size", m.region_size, "In the regions with this tag; repeatable")
      ->group(group);
  add_tag_values(app, "--patch-size", m.patch_size, "On the patches with this tag; repeatable")->group(group);
  add_tag_values(app, "--curve-size", m.curve_size, "On the curves with this tag; repeatable")->group(group);
  app.add_option(
         "--size-field", size_field,
         "Sizes by place: .json (balls, boxes, cylinders, distances from features), or .vtu or .msh with a "
         "scalar on its points")
      ->type_name("FILE")
      ->group(group);
  add(app, "--elements-per-circle N", m.elements_per_circle,
      "Finer where smooth surfaces and edges curve: so many elements on a full circle", "none")
      ->check(number)
      ->group(group);
  add(app, "--elements-across-gap N", m.elements_across_gap,
      "Finer where surfaces face each other across a thin part: so many elements between them", "none")
      ->check(number)
      ->group(group);
  add(app, "--gradation G", m.gradation, "Growth of size per unit length away from finer features",
      "unlimited")
      ->check(number)
      ->group(group);
}

void add_coarsening_options(CLI::App& app, MeshArguments& a) {
  const std::string& group = quality_group;
  app.add_option("--coarsen", a.coarsen,
                 "on: as few tetrahedra as the sizes ask for, thin ones in thin places; off: the bound on "
                 "circumradius / shortest edge holds everywhere outside collars")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, bool>{{"on", true}, {"off", false}}).description(""))
      ->default_str("on")
      ->type_name("on|off")
      ->group(group);
  add(app, "--thin-angle DEGREES", a.thin_angle,
      "Smallest dihedral angle of thin tetrahedra; at sharper creases half their angle")
      ->check(thin_angle)
      ->group(group);
}

void add_improvement_options(CLI::App& app, MeshArguments& a) {
  const std::string& group = quality_group;
  add(app, "--improve LEVEL", a.improve, "Removal of slivers: 0 none, 1 quick, 2 good, 3 best")
      ->check(one_of({"0", "1", "2", "3"}))
      ->group(group);
  add(app, "--min-dihedral DEGREES", a.min_dihedral,
      "Improve tetrahedra with smaller dihedral angles, degrees", "15, 20, 30 by level")
      ->check(number_in(0, 60, "an angle from 0 to 60 degrees"))
      ->group(group);
}

void add_order_option(CLI::App& app, unsigned& order) {
  add(app, "--order ORDER", order,
      "Of the cells: 1 straight with nodes at the corners, 2 with a node amid every edge, curved on smooth "
      "surfaces")
      ->check(one_of({"1", "2"}))
      ->group(elements_group);
}

void add_distance_option(CLI::App& app, MeshOptions& m) {
  add(app, "--distance LENGTH", m.distance,
      "Largest distance from smooth surfaces and curves, absolute, input units",
      "1/10 of the size, at most 1/200 of the diagonal (1/550 with --order 2)")
      ->check(length)
      ->group(quality_group);
}

void add_partition_options(CLI::App& app, MeshArguments& a) {
  add(app, "--partitions N", a.partitions,
      "Divide the tetrahedra among so many ranks, evenly and with few shared faces", "not divided")
      ->check(number_in(1, 1e6, "a number of partitions from 1 to 1000000"))
      ->check(count)
      ->group(partitions_group);
  app.add_flag_callback(
         "--ghost-cells", [&a] { a.ghost_cells = io::GhostCells::one_layer; },
         "With each partition the tetrahedra of others that share a vertex with it; " +
             list(io::formats_with_ghost_cells()))
      ->group(partitions_group);
  app.add_option("--cell-decomposition", a.cell_decomposition,
                 "Also write the partition of each tetrahedron as a list that OpenFOAM's decomposePar reads")
      ->type_name("FILE")
      ->group(partitions_group);
}

void add_quality_options(CLI::App& app, MeshOptions& m) {
  const std::string& group = quality_group;
  add(app, "--radius-edge RHO", m.radius_edge, "Bound on circumradius / shortest edge of a tetrahedron")
      ->check(ratio)
      ->group(group);
  add(app, "--vertex-ratio TAU", m.vertex_ratio,
      "Bound on largest circumradius / shortest edge at a vertex, more than 2 sqrt 2", "none")
      ->check(length)
      ->group(group);
  add(app, "--collar-angle DEGREES", m.collar_angle,
      "Bound on dihedral angles in the collars around creases, degrees")
      ->check(collar_angle)
      ->group(group);
  const std::map<std::string, CollarCreation> creations{{"up-front", CollarCreation::up_front},
                                                        {"in-pass", CollarCreation::in_pass}};
  app.add_option(
         "--collar-creation", m.collar_creation,
         "Place the balls around creases each in the pass (the paper's way), or all before the refinement")
      ->transform(CLI::CheckedTransformer(creations).description(""))
      ->default_str("in-pass")
      ->type_name("in-pass|up-front")
      ->group(group);
  add(app, "--theta THETA", m.theta, "Warp to input within this times a gap ball's radius; 0: never")
      ->check(number_in(0, 0.449, "a number from 0 to below 0.45"))
      ->group(group);
  add_distance_option(app, m);
  add(app, "--seed N", m.seed, "Of the pseudo-random offsets: same input, options and seed, same mesh")
      ->check(count)
      ->group(group);
}

void add_budget_options(CLI::App& app, MeshOptions& m) {
  const std::string group = "Budgets (hitting one is exit code 5)";
  add(app, "--max-vertices N", m.max_vertices, "Vertices of the triangulation, outside included", "none")
      ->check(count)
      ->group(group);
  m.max_memory = memory_of_the_machine() / 2;
  const auto set_memory = [&m](const std::string& text) {
    try {
      m.max_memory = parse_memory(text);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--max-memory", error.what());
    }
  };
  app.add_option_function<std::string>("--max-memory", set_memory,
                                       "Bytes for everything, as 500M or 1.5G; 0: none")
      ->default_str("half of the machine's")
      ->group(group)
      ->type_name("BYTES");
  add(app, "--time-limit SECONDS", m.time_limit, "For all stages together", "none")
      ->check(seconds)
      ->group(group);
}

void add_threads_option(CLI::App& app, unsigned& threads, const std::string& what) {
  add(app, "--threads N", threads, what + "; 0: as many as there are cores. They change no result")
      ->check(number_in(0, 1024, "a number of threads from 0 to 1024"))
      ->check(count);
}

bool is_meshing_group(const std::string& group) {
  return group == size_group || group == quality_group || group == elements_group;
}

void add_quiet_flag(CLI::App& app, bool& quiet) {
  app.add_flag("-q,--quiet", quiet, "Say nothing unless something is wrong");
}

}  // namespace

void add_run_options(CLI::App& app, MeshArguments& a) {
  add_size_options(app, a.mesh, a.size_field);
  add_quality_options(app, a.mesh);
  add_coarsening_options(app, a);
  add_improvement_options(app, a);
  add_order_option(app, a.order);
  add_partition_options(app, a);
  add_complex_options(app, a.complex);
  add_budget_options(app, a.mesh);
  add_threads_option(app, a.threads, "Of coarsening, improvement, certificate and writing, at most");
  add(app, "--scale FACTOR", a.scale,
      "Coordinates are multiplied by this when they are written, 0.001 for m of mm")
      ->check(number_in(1e-100, 1e100, "a positive number"));
  app.add_option("--report", a.reports,
                 "Write what was measured, as JSON, or as a page to look at (.html); may be given for each")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const auto set_progress = [&a](const std::string& word) {
    a.progress = word == "json"   ? ProgressStyle::json
                 : word == "none" ? ProgressStyle::none
                                  : ProgressStyle::automatic;
  };
  app.add_option_function<std::string>("--progress", set_progress,
                                       "auto (a bar on a terminal), json (one object a line) or none")
      ->check(one_of({"auto", "json", "none"}))
      ->default_str("auto")
      ->type_name("STYLE");
  app.add_flag("-v,--verbose", a.verbose, "Say more: time per stage, statistics");
  add_quiet_flag(app, a.quiet);
}

namespace {

void add_output_format(CLI::App& app, std::string& format, const std::string& when) {
  app.add_option("--format", format, "Of the output, an extension such as vtu or msh2" + when)
      ->transform(format_name(all_formats()))
      ->type_name("FORMAT")
      ->default_str("by extension");
}

void add_mesh_options(CLI::App& app, MeshArguments& a) {
  app.add_option("INPUT", a.inputs,
                 "Surfaces, complexes and CAD shapes (" + known_inputs() + "); several are one complex")
      ->type_name("FILE");
  app.add_option("-o,--output", a.output, "The mesh to write: " + list(io::written_tet_mesh_formats()))
      ->type_name("FILE");
  add_output_format(app, a.output_format, "");
  add_run_options(app, a);
}

/// The files of commands that make one file of others; both kinds of arguments have these members.
template <class SomeArguments>
void add_conversion_files(CLI::App& app, SomeArguments& a, const std::string& inputs) {
  app.add_option("IN", a.inputs, inputs + "; -: standard input")->required()->type_name("FILE");
  app.add_option("-o,--output", a.output, "The file to write; -: standard output")
      ->required()
      ->type_name("FILE");
  add_output_format(app, a.output_format, "; needed for -");
  app.add_option("--input-format", a.input_format, "Of the inputs; needed for -")
      ->transform(format_name(all_formats()))
      ->type_name("FORMAT")
      ->default_str("by extension");
}

CLI::App* add_convert_command(CLI::App& app, MeshArguments& a) {
  CLI::App* convert = app.add_subcommand(
      "convert",
      "Convert surfaces, complexes and meshes into each other; a surface into a mesh by meshing it");
  add_conversion_files(*convert, a, "Surfaces and complexes, which become one, or one mesh");
  add_run_options(*convert, a);
  return convert;
}

CLI::App* add_check_command(CLI::App& app, CheckArguments& a) {
  CLI::App* check = app.add_subcommand("check", "Certify a mesh against the input it was made from");
  check->add_option("MESH", a.mesh, "The mesh: " + list(io::read_tet_mesh_formats()))
      ->required()
      ->type_name("FILE");
  check->add_option("--against", a.inputs, "The input: one or several files")->required()->type_name("FILE");
  add(*check, "--radius-edge RHO", a.check.radius_edge,
      "Bound on circumradius / shortest edge of a tetrahedron")
      ->check(ratio);
  add(*check, "--thin-angle DEGREES", a.check.thin_angle,
      "Smallest dihedral angle of thin tetrahedra, which may exceed that bound; 0: none may")
      ->check(number_in(0, 30, "an angle from 0 to 30 degrees"));
  add(*check, "--collar-angle DEGREES", a.check.collar_angle, "Bound on dihedral angles in collars, degrees")
      ->check(collar_angle);
  add(*check, "--distance LENGTH", a.check.distance,
      "Largest distance from smooth surfaces and curves, absolute, input units", "1/200 of the diagonal")
      ->check(length);
  add(*check, "--findings N", a.check.findings_per_guarantee, "List at most this many per guarantee")
      ->check(count);
  add_threads_option(*check, a.check.threads, "At most");
  add_complex_options(*check, a.complex);
  add(*check, "--time-limit SECONDS", a.time_limit, "For everything", "none")->check(seconds);
  check->add_flag("--json", a.json, "Print JSON");
  return check;
}

CLI::App* add_info_command(CLI::App& app, InfoArguments& a) {
  CLI::App* info = app.add_subcommand("info", "Say what the input is: features, regions, creases, angles");
  info->add_option("INPUT", a.inputs, "Files of one complex, or one mesh")->required()->type_name("FILE");
  add_complex_options(*info, a.complex);
  add(*info, "--time-limit SECONDS", a.time_limit, "For everything", "none")->check(seconds);
  info->add_flag("--json", a.json, "Print JSON");
  CLI::Option* const predict =
      info->add_option("--predict", a.predicted_sizes,
                       "Estimate the tetrahedra and seconds that meshes of these sizes take, without making "
                       "them; 0: the default size")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(length)
          ->type_name("LENGTH,...");
  const auto others = info->get_options();
  add_size_options(*info, a.mesh, a.size_field);
  add_distance_option(*info, a.mesh);
  add_order_option(*info, a.order);
  for (CLI::Option* option : info->get_options())
    if (std::find(others.begin(), others.end(), option) == others.end()) option->needs(predict);
  return info;
}

CLI::App* add_repair_command(CLI::App& app, RepairArguments& a) {
  CLI::App* repair = app.add_subcommand(
      "repair", "Write the facets that would be meshed: repaired where they are no valid complex");
  add_conversion_files(*repair, a, "Surfaces, complexes and CAD shapes, which become one");
  add_complex_options(*repair, a.complex);
  repair->add_option("--report", a.report, "Write what was repaired as JSON")->type_name("FILE");
  add(*repair, "--time-limit SECONDS", a.time_limit, "For everything", "none")->check(seconds);
  repair->add_flag("--json", a.json, "Print what was repaired as JSON");
  add_quiet_flag(*repair, a.quiet);
  return repair;
}

std::string extension_list(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension.empty() ? "has no extension" : fmt::format("ends in '{}'", extension);
}

template <class SomeArguments>
std::vector<std::string> all_inputs(const SomeArguments& a) {
  std::vector<std::string> inputs = a.inputs;
  if (!a.complex.names.empty()) inputs.push_back(a.complex.names);
  if constexpr (requires { a.size_field; })
    if (!a.size_field.empty()) inputs.push_back(a.size_field);
  return inputs;
}

const std::vector<std::string>& reports_of(const MeshArguments& a) { return a.reports; }

std::vector<std::string> reports_of(const RepairArguments& a) {
  return a.report.empty() ? std::vector<std::string>{} : std::vector{a.report};
}

/// Of a run that writes a mesh, a file beside it.
template <class SomeArguments>
void check_second_output(const char* option, const std::string& file, const SomeArguments& a) {
  if (file.empty()) return;
  if (may_write(a.output, a.output_format, file))
    throw CLI::ValidationError(option, "names a file of --output; choose another");
  const std::string lost = overwritten({file}, all_inputs(a), a.input_format);
  if (!lost.empty())
    throw CLI::ValidationError(option, fmt::format("would overwrite {}; choose another", lost));
}

/// No output takes the place of an input, or of another output.
template <class SomeArguments>
void check_outputs(const SomeArguments& a) {
  const std::string in_the_way =
      overwritten(files_written(a.output, a.output_format), all_inputs(a), a.input_format);
  if (!in_the_way.empty())
    throw CLI::ValidationError(
        "--output",
        fmt::format("'{}' would overwrite {}; choose another name or folder", a.output, in_the_way));
  std::vector<std::string> others;
  for (const std::string& report : reports_of(a)) {
    check_second_output("--report", report, a);
    if (!overwritten({report}, others, {}).empty())
      throw CLI::ValidationError("--report", fmt::format("names {} twice; choose another", report));
    others.push_back(report);
  }
  if constexpr (requires { a.cell_decomposition; }) {
    check_second_output("--cell-decomposition", a.cell_decomposition, a);
    if (!a.cell_decomposition.empty() && !overwritten({a.cell_decomposition}, others, {}).empty())
      throw CLI::ValidationError("--cell-decomposition", "names the file of --report; choose another");
  }
}

bool is_among(const std::string& path, const std::string& format, const std::vector<std::string>& formats) {
  return std::find(formats.begin(), formats.end(), format_of(path, format)) != formats.end();
}

/// Partitions are for formats that keep them. `from_mesh`: one that may be partitioned already.
void check_partitions(const MeshArguments& a, bool from_mesh) {
  if (a.partitions > 0 && !is_among(a.output, a.output_format, io::formats_with_partitions()))
    throw CLI::ValidationError("--partitions", fmt::format("{} has no place for partitions; use {}",
                                                           format_of(a.output, a.output_format),
                                                           list(io::formats_with_partitions())));
  if (!a.cell_decomposition.empty() && !io::is_tet_mesh_format(a.output, a.output_format))
    throw CLI::ValidationError("--cell-decomposition", "is of a mesh, but the output is a surface");
  if (!a.cell_decomposition.empty() && a.partitions == 0 && !from_mesh)
    throw CLI::ValidationError("--cell-decomposition", "is of partitions; say how many with --partitions");
  if (a.ghost_cells == io::GhostCells::none) return;
  if (!is_among(a.output, a.output_format, io::formats_with_ghost_cells()))
    throw CLI::ValidationError("--ghost-cells", fmt::format("{} has no place for ghost cells; use {}",
                                                            format_of(a.output, a.output_format),
                                                            list(io::formats_with_ghost_cells())));
  if (a.partitions == 0 && !from_mesh)
    throw CLI::ValidationError("--ghost-cells", "is of partitions; say how many with --partitions");
}

}  // namespace

void check_run_arguments(const MeshArguments& a) {
  if (a.verbose && a.quiet) throw CLI::ValidationError("--quiet", "contradicts --verbose; use one of them");
  check_outputs(a);
  if (a.mesh.size > 0 && a.mesh.size_min > a.mesh.size)
    throw CLI::ValidationError(
        "--size-min", fmt::format("{} exceeds --size {}; make it smaller", a.mesh.size_min, a.mesh.size));
  if (a.mesh.vertex_ratio != 0 && a.mesh.vertex_ratio <= 2 * std::sqrt(2.0))
    throw CLI::ValidationError("--vertex-ratio", "must exceed 2 sqrt 2 = 2.83 (the proved bound)");
}

namespace {

void check_mesh_arguments(const MeshArguments& a) {
  if (a.inputs.empty()) throw CLI::RequiredError("INPUT, a file to mesh,");
  if (a.output.empty()) throw CLI::RequiredError("--output, the mesh to write,");
  if (a.output == "-")
    throw CLI::ValidationError(
        "--output",
        "- is standard output, to which convert writes: collarmesh convert IN... -o - --format vtu");
  if (!io::is_tet_mesh_format(a.output, a.output_format))
    throw CLI::ValidationError("--output", fmt::format("'{}' {}; use {}", a.output, extension_list(a.output),
                                                       list(io::written_tet_mesh_formats())));
  check_partitions(a, false);
  check_run_arguments(a);
}

template <class SomeArguments>
void check_standard_input(const SomeArguments& a) {
  const auto dashes = std::count(a.inputs.begin(), a.inputs.end(), "-");
  if (dashes > 1) throw CLI::ValidationError("IN", "standard input (-) can be read once only");
  if (dashes > 0 && a.input_format.empty())
    throw CLI::ValidationError("--input-format", "is needed for standard input (-)");
}

void check_repair_arguments(const RepairArguments& a) {
  if (!is_surface_format(a.output, a.output_format))
    throw CLI::ValidationError("--output", fmt::format("'{}' {}; use {}, or name one with --format", a.output,
                                                       extension_list(a.output), list(surface_formats())));
  if (a.output == "-" && a.json)
    throw CLI::ValidationError("--json", "has no place on standard output beside the file; use --report");
  if (is_html(a.report))
    throw CLI::ValidationError("--report", "is JSON here; pages (.html) are made of meshes");
  check_standard_input(a);
  check_outputs(a);
}

void check_convert_arguments(const MeshArguments& a) {
  if (a.output_format.empty() && !is_surface_format(a.output) && !io::is_tet_mesh_format(a.output))
    throw CLI::ValidationError("--output", fmt::format("'{}' {}; use {}, or name one with --format", a.output,
                                                       extension_list(a.output), known_formats()));
  check_standard_input(a);
  check_partitions(a, io::is_tet_mesh_format(a.inputs.front(), a.input_format));
  if (a.output == "-" &&
      (a.output_format == ".ele" || a.output_format == ".xdmf" || a.output_format == ".pvtu"))
    throw CLI::ValidationError("--format", "is of several files, which standard output cannot take");
  check_run_arguments(a);
}

/// CLI11's help with our usage lines.
class HelpText : public CLI::Formatter {
 public:
  HelpText() { column_width(34); }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() != nullptr) return CLI::Formatter::make_usage(app, name);
    std::string text = "Usage:";
    for (const char* command : {"", "check", "info", "convert", "repair"})
      text += fmt::format("{} {} [options]\n", text.size() > 6 ? "      " : "", usage_of(command));
    return text;
  }
};

constexpr const char* footer =
    "Exit codes: 0 every guarantee holds, 1 internal error, 2 usage, 3 unreadable input,\n"
    "4 not a valid complex, 5 a budget was hit, 6 cancelled,\n"
    "7 a guarantee is missed (the mesh is written), 8 cannot write. 1 to 6 and 8 write no mesh.\n"
    "Lengths are in input units (millimetres for CAD files); 'diagonal' is the bounding box's.";

}  // namespace

std::variant<Arguments, ExitCode> parse(int argc, const char* const* argv) {
  MeshArguments mesh;
  CheckArguments check;
  InfoArguments info;
  ConvertArguments convert;
  RepairArguments repair;
  CLI::App app("collarmesh: tetrahedral meshes of piecewise-linear complexes, certified", "collarmesh");
  app.set_version_flag("--version", "collarmesh " COLLARMESH_VERSION);
  app.formatter(std::make_shared<HelpText>());
  app.footer(footer);
  app.require_subcommand(0, 1);
  add_mesh_options(app, mesh);
  CLI::App* const check_command = add_check_command(app, check);
  CLI::App* const info_command = add_info_command(app, info);
  CLI::App* const convert_command = add_convert_command(app, convert.mesh);
  CLI::App* const repair_command = add_repair_command(app, repair);
  if (argc == 3 && argv[1] == std::string_view("--generate")) {  // when it is built; not for users
    const std::string_view kind = argv[2];
    fmt::print("{}", kind == "man" ? man_page(app, COLLARMESH_VERSION, footer) : completion(app, kind));
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
      check_convert_arguments(convert.mesh);
      convert.repair = convert_command->get_option("--repair")->count() > 0 &&
                       convert.mesh.complex.repair.mode != RepairMode::off;
      for (const CLI::Option* option : convert_command->get_options())
        if (option->count() > 0 && is_meshing_group(option->get_group()))
          convert.meshing_options.push_back(option->get_name());
    }
    if (repair_command->parsed()) check_repair_arguments(repair);
    if (subcommand && (!mesh.inputs.empty() || !mesh.output.empty())) throw CLI::HorribleError("");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text, nothing;
      app.exit(error, text, nothing);
      print_result(text.str());
      return ExitCode::success;
    }
    const bool subcommand_last =
        !app.get_subcommands().empty() && (!mesh.inputs.empty() || !mesh.output.empty());
    tell("collarmesh: {}\nRun with --help for more information.\n",
         subcommand_last ? "a subcommand comes first: collarmesh check MESH ..., info INPUT ..., "
                           "convert IN ..., repair IN ..."
                         : usage_message(app, error));
    return ExitCode::usage;
  }
  if (check_command->parsed()) return Arguments(check);
  if (info_command->parsed()) return Arguments(info);
  if (repair_command->parsed()) return Arguments(repair);
  if (convert_command->parsed()) {
    convert.mesh.tell_losses = true;
    return Arguments(convert);
  }
  return Arguments(mesh);
}

}  // namespace collarmesh::cli
