#include "mesh_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

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
#include "scale.h"
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
  /// One of those between building the complex and writing, with what is told in it.
  void update(ProgressReport report) {
    const double fraction = 0.08 + 0.85 * report.fraction;
    if (report.begins) {
      begin_ = fraction;
      begin(std::string(report.phase), begin_, begin_ + 1, report.tets);
      return;
    }
    note_stage(fmt::format("stage: {}, {} vertices, {} tets", report.phase, report.vertices, report.tets));
    report.fraction = fraction - begin_;
    display_.update(report);
  }
  void print(const std::string& text) { display_.print(text); }

 private:
  ProgressDisplay display_;
  StageTimes& times_;
  double begin_ = 0;
};

PipelineOptions pipeline_options(const MeshArguments& a) {
  PipelineOptions options;
  options.mesh = a.mesh;
  options.mesh.crease_angle = a.complex.crease_angle;
  options.mesh.time_limit = 0;  // one limit for everything, from reading to writing: the interrupt flag
  options.coarsen = a.coarsen;
  options.thin_angle = a.thin_angle;
  options.improve = a.improve;
  options.min_dihedral = a.min_dihedral;
  options.order = a.order;
  options.threads = a.threads;
  return options;
}

ComplexInput read_inputs(const MeshArguments& arguments, Stages& stages) {
  stages.begin("read", 0, 0.02);
  const auto distance = [&](double diagonal) { return distance_of(pipeline_options(arguments), diagonal); };
  return ComplexInput(arguments.inputs,
                      interruptible({arguments.input_format, distance, arguments.complex.overlap}));
}

void take_complex(const MeshArguments& arguments, Plc plc, const ComplexInput& input, Stages& stages,
                  MeshRun& run) {
  run.plc = std::move(plc);
  run.notes = input.notes();
  run.repair = input.repaired();
  require_known_tags(arguments.mesh, run.plc);
  run.summary = summarize(run.plc, arguments.complex.crease_angle);
  run.warnings = option_warnings(arguments, run.plc);
  std::string text = warnings_text(run.plc) + repair_text(run.repair, arguments.quiet);
  for (const std::string& warning : run.warnings) text += fmt::format("warning: {}\n", warning);
  stages.print(text);
}

/// For the message when the time is up.
void note_where_it_stopped(const MeshResult& result) {
  const MeshStatistics& reached = result.statistics;
  const Point& p = result.where;
  note_stage(fmt::format(
      "stage: refine, {} vertices, {} cells, {:.1f} MB; the last vertex is ({:.9g}, {:.9g}, {:.9g})",
      reached.vertices_inserted, reached.cells, static_cast<double>(reached.peak_bytes) / 1e6, p.x, p.y,
      p.z));
}

/// `next`: the repair that comes next should the mesh miss a guarantee.
void mesh(const MeshArguments& arguments, const ComplexInput& input, const std::optional<RepairOptions>& next,
          Stages& stages, MeshRun& run) {
  PipelineOptions options = pipeline_options(arguments);
  if (!arguments.size_field.empty()) options.mesh.size_field = read_size_field(arguments.size_field, run.plc);
  if (input.has_cad()) options.exact = input.exact_geometry(run.plc);
  if (next) options = before_next_repair(std::move(options), *next, run.plc);
  Execution execution;
  execution.cancel = &interrupt_flag();
  std::optional<CadWork> projecting;
  execution.progress = [&](const ProgressReport& report) {
    if (!input.has_cad() || (report.phase != "project" && report.phase != "second order"))
      projecting.reset();
    else if (!projecting)
      projecting.emplace("finding the nearest points of its faces and edges", input.cad_names());
    stages.update(report);
    return true;
  };
  static_cast<PipelineResult&>(run) = run_pipeline(run.plc, options, execution);
  if (run.repair.repaired)
    run.check.notes.push_back(fmt::format("the mesh was judged against the {} complex",
                                          run.repair.wrapped ? "wrapped" : "repaired"));
  if (run.result.status == MeshStatus::cancelled) {
    if (run.times.stages().back().first == "refine") note_where_it_stopped(run.result);
    stop_if_interrupted();
  }
  if (run.result.status == MeshStatus::budget_hit && !(next && next->wrap_at_once))
    throw Stopped(ExitCode::budget_hit, run.result.message + "; nothing was written");
  if (input.has_cad()) run.result.mesh.group_names = GroupNames::cad;
}

void mesh_with_repairs(const MeshArguments& arguments, ComplexInput& input, Stages& stages, MeshRun& run) {
  ComplexArguments how = arguments.complex;
  const std::optional<RepairOptions> next = next_repair(how.repair, run.repair);
  std::string missed;
  bool has_mesh = false;
  try {
    mesh(arguments, input, next, stages, run);
    if (run.guarantees_hold()) return;
    missed = run.missed();
    has_mesh = run.result.status != MeshStatus::budget_hit;
  } catch (const PlcError& error) {
    if (!next) throw;
    missed = error.what();
  }
  if (!next) return;
  std::optional<Plc> plc = input.build_next(how);
  if (!plc && has_mesh) return;
  if (!plc) throw PlcError(missed, {});
  stages.print(how.repair.wrap_at_once
                   ? fmt::format("wrapped: {}\n", missed)
                   : fmt::format("repaired again, with --repair-tolerance {:.3g}: at {:.3g} {}\n",
                                 how.repair.tolerance, arguments.complex.repair.tolerance, missed));
  take_complex(arguments, *std::move(plc), input, stages, run);
  mesh(arguments, input, std::nullopt, stages, run);
}

void write_report(const std::string& path, const MeshArguments& arguments, const MeshRun& run) {
  std::ofstream file(path);
  file << json_text(run_json(arguments, run), 1) << '\n';
  file.close();
  if (!file) throw WriteError(fmt::format("{}: cannot be written; is the disk full?", path));
}

void write_files(const MeshArguments& arguments, Stages& stages, MeshRun& run) {
  stages.begin("write", 0.93, 1, run.result.mesh.tets.size());
  scale(run.result.mesh.points, arguments.scale);
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
    ComplexInput input = read_inputs(arguments, stages);
    stages.begin("complex", 0.02, 0.08);
    take_complex(arguments, input.build(arguments.complex), input, stages, run);
    mesh_with_repairs(arguments, input, stages, run);
    write_files(arguments, stages, run);
  }
  tell_of(arguments, run);
  return run.guarantees_hold() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
