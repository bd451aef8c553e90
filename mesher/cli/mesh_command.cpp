#include "mesh_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>

#include "collarmesh/error.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "complex_input.h"
#include "console.h"
#include "conversion_report.h"
#include "interrupt.h"
#include "option_warnings.h"
#include "out_of_memory.h"
#include "progress_display.h"
#include "report.h"
#include "staged_file.h"
#include "supervisor.h"

namespace collarmesh::cli {

namespace {

/// Begins stages, both in the display and in the timing.
class Stages {
 public:
  Stages(ProgressStyle style, StageTimes& times) : display_(style), times_(times) {}

  void begin(const std::string& phase, double begin, double end, std::size_t tets = 0) {
    stop_if_interrupted();
    note_stage(tets > 0 ? fmt::format("stage: {}, {} tets", phase, tets) : fmt::format("stage: {}", phase));
    times_.begin(phase);
    display_.begin_stage(phase, begin, end);
  }
  void update(const ProgressReport& report) {
    note_stage(fmt::format("stage: {}, {} vertices, {} tets", report.phase, report.vertices, report.tets));
    display_.update(report);
  }
  void print(const std::string& text) { display_.print(text); }

 private:
  ProgressDisplay display_;
  StageTimes& times_;
};

template <class Features>
void require_tags(const std::map<Tag, double>& sizes, const Features& features, const std::string& option,
                  const std::string& what) {
  std::set<Tag> tags;
  for (const auto& feature : features) tags.insert(feature.tag);
  for (const auto& [tag, size] : sizes) {
    if (tags.count(tag) > 0) continue;
    std::string known;
    for (const Tag each : tags) {
      if (known.size() > 60) {
        known += ", ...";
        break;
      }
      known += (known.empty() ? "" : ", ") + std::to_string(each);
    }
    throw OptionError(fmt::format("{} {}={}: no {} has the tag {}; the tags are {}", option, tag, size, what,
                                  tag, known.empty() ? "none" : known));
  }
}

void require_known_tags(const MeshOptions& options, const Plc& plc) {
  const std::vector<Plc::Region> solids(
      plc.regions.begin() + std::min<std::ptrdiff_t>(1, std::ssize(plc.regions)), plc.regions.end());
  require_tags(options.region_size, solids, "--region-size", "region");
  require_tags(options.patch_size, plc.patches, "--patch-size", "patch");
  require_tags(options.curve_size, plc.curves, "--curve-size", "curve");
}

double distance_of(const MeshArguments& arguments, double diagonal) {
  return arguments.mesh.distance > 0 ? arguments.mesh.distance
                                     : default_distance(arguments.mesh.size, diagonal, arguments.order);
}

ComplexInput build_complex(const MeshArguments& arguments, Stages& stages, MeshRun& run) {
  stages.begin("read", 0, 0.02);
  const auto distance = [&](double diagonal) { return distance_of(arguments, diagonal); };
  ComplexInput input(arguments.inputs, {arguments.input_format, distance, arguments.complex.overlap});
  stages.begin("complex", 0.02, 0.08);
  run.plc = input.build(arguments.complex);
  run.notes = input.notes();
  run.repair = input.repaired();
  require_known_tags(arguments.mesh, run.plc);
  run.summary = summarize(run.plc, arguments.complex.crease_angle);
  run.warnings = option_warnings(arguments, run.plc);
  std::string text = warnings_text(run.plc) + repair_text(run.repair, arguments.quiet);
  for (const std::string& warning : run.warnings) text += fmt::format("warning: {}\n", warning);
  stages.print(text);
  return input;
}

MeshOptions options_of_refinement(const MeshArguments& arguments, const ComplexInput& input,
                                  const MeshRun& run) {
  MeshOptions options = arguments.mesh;
  options.crease_angle = arguments.complex.crease_angle;
  if (!arguments.size_field.empty()) options.size_field = read_size_field(arguments.size_field, run.plc);
  options.time_limit = 0;  // one limit for all stages: the interrupt flag
  options.distance = distance_of(arguments, run.plc.bounds.diagonal());
  return input.tightened(options, run.plc);
}

void refine(const MeshArguments& arguments, const ComplexInput& input, const MeshOptions& options,
            Stages& stages, MeshRun& run) {
  stages.begin("refine", 0.08, arguments.coarsen ? 0.6 : 0.7);
  Execution execution;
  execution.cancel = &interrupt_flag();
  execution.progress = [&stages](const ProgressReport& report) {
    stages.update(report);
    return true;
  };
  run.result = generate(run.plc, options, execution);
  if (input.has_cad()) run.result.mesh.group_names = GroupNames::cad;
  if (run.result.status == MeshStatus::cancelled) {
    const MeshStatistics& reached = run.result.statistics;
    const Point& p = run.result.where;
    note_stage(fmt::format(
        "stage: refine, {} vertices, {} cells, {:.1f} MB; the last vertex is ({:.9g}, {:.9g}, {:.9g})",
        reached.vertices_inserted, reached.cells, static_cast<double>(reached.peak_bytes) / 1e6, p.x, p.y,
        p.z));
    stop_if_interrupted();
  }
  if (run.result.status == MeshStatus::budget_hit)
    throw Stopped(ExitCode::budget_hit, run.result.message + "; nothing was written");
}

/// Of the bounds on angles, where vertices move onto exact geometry afterwards.
double reserve_of_angles(const ComplexInput& input) { return input.has_cad() ? 0.05 : 0; }

void coarsen_elements(const MeshArguments& arguments, const ComplexInput& input, const MeshOptions& options,
                      Stages& stages, MeshRun& run) {
  if (!arguments.coarsen || run.result.status != MeshStatus::complete) return;
  stages.begin("coarsen", 0.6, 0.7, run.result.mesh.tets.size());
  Execution execution;
  execution.cancel = &interrupt_flag();
  run.coarsening =
      coarsen(run.result.mesh, run.plc, options,
              {.thin_angle = arguments.thin_angle, .reserve = reserve_of_angles(input)}, execution);
  stop_if_interrupted();
}

void improve_elements(const MeshArguments& arguments, const ComplexInput& input, const MeshOptions& bounds,
                      Stages& stages, MeshRun& run) {
  if (arguments.improve == 0) return;
  stages.begin("improve", 0.7, 0.79, run.result.mesh.tets.size());
  Execution execution;
  execution.cancel = &interrupt_flag();
  ImproveOptions options = improve_options(arguments.improve);
  options.radius_edge = bounds.radius_edge;
  options.distance = bounds.distance;
  options.threads = arguments.threads;
  if (run.coarsening) {
    options.thin_angle = arguments.thin_angle;
    options.thin_reserve = reserve_of_angles(input);
    options.keep_vertices = true;
  }
  if (arguments.min_dihedral > 0) options.min_dihedral = arguments.min_dihedral;
  run.improvement = improve(run.result.mesh, run.plc, options, execution);
  stop_if_interrupted();
}

void project_onto_cad(const MeshArguments& arguments, const ComplexInput& input, Stages& stages,
                      MeshRun& run) {
  if (!input.has_cad()) return;
  stages.begin("project", 0.79, 0.8, run.result.mesh.tets.size());
  Execution execution;
  execution.cancel = &interrupt_flag();
  ProjectOptions options;
  options.radius_edge = arguments.mesh.radius_edge;
  options.collar_angle = arguments.mesh.collar_angle;
  options.reach = distance_of(arguments, run.plc.bounds.diagonal());
  if (run.coarsening) options.thin_angle = arguments.thin_angle;
  const CadWork projecting("finding the nearest points of its faces and edges", input.cad_names());
  run.projection =
      project_boundary(run.result.mesh, run.plc, input.exact_geometry(run.plc), options, execution);
  stop_if_interrupted();
}

void raise_order(const MeshArguments& arguments, const ComplexInput& input, Stages& stages, MeshRun& run) {
  if (arguments.order == 1) return;
  stages.begin("second order", 0.8, 0.83, run.result.mesh.tets.size());
  Execution execution;
  execution.cancel = &interrupt_flag();
  SecondOrderOptions options;
  if (input.has_cad()) options.exact = input.exact_geometry(run.plc);
  std::optional<CadWork> projecting;
  if (input.has_cad())
    projecting.emplace("finding the nearest points of its faces and edges", input.cad_names());
  run.second_order = make_second_order(run.result.mesh, run.plc, options, execution);
  stop_if_interrupted();
}

void certify(const MeshArguments& arguments, Stages& stages, MeshRun& run) {
  stages.begin("check", 0.83, 0.93, run.result.mesh.tets.size());
  CheckOptions options;
  options.radius_edge = arguments.mesh.radius_edge;
  options.distance = distance_of(arguments, run.plc.bounds.diagonal());
  options.thin_angle = arguments.thin_angle;
  options.collar_angle = arguments.mesh.collar_angle;
  options.crease_angle = arguments.complex.crease_angle;
  options.threads = arguments.threads;
  run.check = check(run.result.mesh, run.plc, options);
  if (run.repair.repaired)
    run.check.notes.push_back(fmt::format("the mesh was judged against the {} complex",
                                          run.repair.wrapped ? "wrapped" : "repaired"));
}

void write_report(const std::string& path, const MeshArguments& arguments, const MeshRun& run) {
  std::ofstream file(path);
  file << json_text(run_json(arguments, run), 1) << '\n';
  file.close();
  if (!file) throw WriteError(fmt::format("{}: cannot be written; is the disk full?", path));
}

void write_files(const MeshArguments& arguments, Stages& stages, MeshRun& run) {
  stages.begin("write", 0.93, 1, run.result.mesh.tets.size());
  StagedFile mesh(arguments.output);
  mesh.write(
      [&](const std::string& path) { io::write_tet_mesh(path, run.result.mesh, arguments.output_format); });
  run.times.end();
  std::optional<StagedFile> report;
  if (!arguments.report.empty()) {
    report.emplace(arguments.report);
    report->write([&](const std::string& path) { write_report(path, arguments, run); });
  }
  StagedFile::commit({&mesh, report ? &*report : nullptr});
}

void tell_of(const MeshArguments& arguments, const MeshRun& run) {
  if (run.result.status == MeshStatus::guarantee_missed)
    tell("collarmesh: a guarantee is missed: {}\n", run.result.message);
  constexpr std::size_t listed = 10;
  tell("{}", findings_text(run.check, arguments.verbose ? run.check.findings.size() : listed));
  tell("{}", straightened_text(run.second_order,
                               arguments.verbose ? run.second_order.straightened.size() : listed));
  if (arguments.quiet) return;
  tell("{}", run_text(arguments, run));
  if (arguments.tell_losses)
    tell("{}", losses_text(lost_by(format_of(arguments.output, arguments.output_format), run.result.mesh)));
}

}  // namespace

ExitCode mesh_command(const MeshArguments& arguments) {
  set_time_limit(arguments.mesh.time_limit);
  limit_memory(arguments.mesh.max_memory);
  require_writable(arguments.output, arguments.output_format);
  if (!arguments.report.empty()) require_writable(arguments.report);
  MeshRun run;
  {
    Stages stages(arguments.quiet ? ProgressStyle::none : arguments.progress, run.times);
    const ComplexInput input = build_complex(arguments, stages, run);
    const MeshOptions options = options_of_refinement(arguments, input, run);
    refine(arguments, input, options, stages, run);
    coarsen_elements(arguments, input, options, stages, run);
    improve_elements(arguments, input, options, stages, run);
    project_onto_cad(arguments, input, stages, run);
    raise_order(arguments, input, stages, run);
    certify(arguments, stages, run);
    write_files(arguments, stages, run);
  }
  tell_of(arguments, run);
  return run.guarantees_hold() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
