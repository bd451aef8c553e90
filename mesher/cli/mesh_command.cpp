#include "mesh_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <optional>

#include "collarmesh/error.h"
#include "collarmesh/io/interfaces_io.h"
#include "collarmesh/io/size_field_io.h"
#include "collarmesh/partition.h"
#include "common/thread_limit.h"
#include "files/cell_decomposition.h"
#include "files/complex_input.h"
#include "files/file_groups.h"
#include "files/surface_files.h"
#include "files/trace_files.h"
#include "interruptible.h"
#include "io/file_format.h"
#include "option_warnings.h"
#include "process/machine.h"
#include "progress_display.h"
#include "report/conversion_report.h"
#include "report/html_report.h"
#include "report/json_text.h"
#include "report/report.h"
#include "scale.h"

namespace collarmesh::cli {

namespace {

PipelineOptions pipeline_options(process::Process& process, const MeshArguments& a) {
  PipelineOptions options = a;
  options.mesh.count_work = !a.reports.empty();
  options.trace = !a.trace_folder.empty();
  options.mesh.time_limit =
      process.interrupts.time_left();  // the whole run is limited, from reading to writing
  return options;
}

/// Records the stage, for the message when the time is up.
void note_where_it_stopped(process::Process& process, const MeshResult& result) {
  const MeshStatistics& reached = result.statistics;
  const Point& p = result.where;
  process.interrupts.note_stage(
      {"refine", reached.vertices_inserted, reached.cells},
      fmt::format(
          "stage: refine, {} vertices, {} cells, {:.1f} MB; the last vertex is ({:.9g}, {:.9g}, {:.9g})",
          reached.vertices_inserted, reached.cells, static_cast<double>(reached.peak_bytes) / 1e6, p.x, p.y,
          p.z));
}

/// Puts the file's name before each line that has none, because a quiet run does not print it elsewhere.
std::string each_line_of(const std::string& file, const std::string& text) {
  std::string named;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string line = text.substr(at, end - at);
    if (line.find(file) == std::string::npos) named.append(file).append(": ");
    named += line;
    at = end;
  }
  return named;
}

/// A builder of complexes from the input files. Prints the changes made for each.
class InputSource : public ComplexSource {
 public:
  /// Keeps references to all arguments.
  InputSource(const MeshArguments& arguments, files::ComplexInput& input, Stages& stages)
      : arguments_(arguments), input_(input), stages_(stages) {}

  RepairedPlc build(const RepairOptions& repair, const Execution&) override {
    if (repair.wrap_at_once)
      stages_.print(
          "wrapping the input, because no mesh of the complex keeps every guarantee within the limit on "
          "vertices\n");
    else if (repair.tolerance != arguments_.repair.tolerance)
      stages_.print(fmt::format(
          "trying --repair-tolerance {:.3g}: with the smaller tolerance, places far thinner than the sizes "
          "take too many vertices, or the mesh misses a guarantee\n",
          repair.tolerance));
    RepairedPlc built{input_.build(arguments_.complex, repair), input_.repaired(), {}};
    built_with_ = repair;
    const std::string told =
        report::warnings_text(built.plc) + report::repair_text(built.report, arguments_.quiet);
    stages_.print(arguments_.quiet ? each_line_of(arguments_.inputs.front(), told) : told);
    return built;
  }

  void adapt(const Plc& plc, PipelineOptions& options) override {
    if (!arguments_.size_field_file.empty()) {
      size_field_use_ = std::make_shared<SizeFieldUse>(default_size(plc, arguments_.mesh));
      options.mesh.size_field = io::read_size_field(arguments_.size_field_file, plc, size_field_use_);
    }
    if (input_.has_cad()) {
      options.exact = input_.exact_geometry(plc);
      options.exact_measures = input_.exact_measures(plc);
    }
    std::string text;
    for (const std::string& warning : option_warnings(arguments_, plc))
      text += fmt::format("warning: {}\n", warning);
    if (arguments_.quiet) text = each_line_of(arguments_.inputs.front(), text);
    if (text != told_of_options_) stages_.print(text);
    told_of_options_ = text;
  }

  const RepairOptions& built_with() const { return built_with_; }

  /// Returns the sources of the size field that had no effect, after a mesh was made.
  std::vector<std::string> without_effect() const {
    std::vector<std::string> told;
    if (size_field_use_)
      for (const std::string& source : size_field_use_->without_effect())
        told.push_back(
            fmt::format("--size-field: {} has no effect: nowhere in the part is its size below {:.6g}, which "
                        "--size asks for.",
                        source, size_field_use_->size()));
    return told;
  }

 private:
  const MeshArguments& arguments_;
  files::ComplexInput& input_;
  Stages& stages_;
  RepairOptions built_with_;
  std::string told_of_options_;                   // warnings about options, printed once even if several
                                                  // meshes are tried
  std::shared_ptr<SizeFieldUse> size_field_use_;  // for the mesh tried last
};

/// Makes the files of a run's steps, if requested. They appear when they are committed.
std::unique_ptr<process::StagedFile> staged_trace(process::Process& process, const MeshArguments& arguments,
                                                  const Trace& trace) {
  if (arguments.trace_folder.empty() || trace.empty()) return nullptr;
  auto staged =
      std::make_unique<process::StagedFile>(process.files, files::trace_file(arguments.trace_folder));
  staged->write([&](const std::string& path) {
    ThreadLimit(arguments.mesh.threads).run([&] { files::write_trace(path, trace); });
  });
  return staged;
}

/// Makes the mesh. Returns the options with which the complex was repaired.
RepairOptions mesh(process::Process& process, const MeshArguments& arguments, files::ComplexInput& input,
                   Stages& stages, report::MeshRun& run) {
  Execution execution;
  execution.cancel = &process.interrupts.flag();
  std::optional<process::CadWork> projecting;
  execution.progress = [&](const ProgressReport& report) {
    if (!input.has_cad() || (report.phase != "project" && report.phase != "second order"))
      projecting.reset();
    else if (!projecting)
      projecting.emplace(process.supervisor, "finding the nearest points of its faces and edges",
                         input.cad_names());
    stages.update(report);
    return true;
  };
  InputSource source(arguments, input, stages);
  static_cast<SoupPipelineResult&>(run) =
      run_pipeline(source, pipeline_options(process, arguments), execution);
  if (run.result.status == MeshStatus::cancelled || run.result.status == MeshStatus::budget_hit) {
    if (run.times.stages().back().first == "refine") note_where_it_stopped(process, run.result);
    process.interrupts.stop_if_asked();
  }
  if (run.result.status == MeshStatus::budget_hit) {
    note_where_it_stopped(process, run.result);
    process.files.commit({staged_trace(process, arguments, run.trace).get()});
    throw process::Stopped(ExitCode::budget_hit, run.result.message + "; nothing was written");
  }
  if (input.has_cad()) run.result.mesh.group_names = GroupNames::cad;
  run.notes = input.notes(arguments.dimension);
  run.colours = input.colours();
  run.summary = summarize(run.plc, arguments.mesh.bounds.crease_angle);
  run.warnings = option_warnings(arguments, run.plc);
  for (std::string& warning : source.without_effect()) {
    stages.print(fmt::format("warning: {}\n", warning));
    run.warnings.push_back(std::move(warning));
  }
  return source.built_with();
}

ProgressStyle progress_of(const MeshArguments& arguments) {
  return arguments.quiet ? ProgressStyle::off : arguments.progress;
}

/// The data that pages show, in the input's unit.
struct Shown {
  report::ShownMesh mesh;
  std::vector<report::ShownStep> trace;
};

/// Writes a report. `shown` is for pages.
void write_report(const std::string& path, const MeshArguments& arguments, const report::MeshRun& run,
                  const std::optional<Shown>& shown) {
  const nlohmann::ordered_json report = report::run_json(arguments, run);
  process::write_text(path, report::is_html(path) ? report::html_report(report, shown->mesh, shown->trace)
                                                  : report::json_text(report, 1) + '\n');
}

void write_files(process::Process& process, const MeshArguments& arguments, Stages& stages,
                 report::MeshRun& run) {
  stages.begin("write", 0.93, 1, run.result.mesh.tets.size());
  if (!arguments.reports.empty()) run.worst = report::worst_tets(run.result.mesh, run.check.measures);
  std::optional<Shown> shown;
  if (std::any_of(arguments.reports.begin(), arguments.reports.end(), report::is_html)) {
    shown = Shown{report::shown_mesh(run.result.mesh, run.worst), {}};
    shown->trace = report::shown_trace(run.trace, shown->mesh);
  }
  scale(run.result.mesh, arguments.scale);
  run.result.mesh.triangle_elements = arguments.triangle_elements;
  process::StagedFile mesh(process.files, arguments.output);
  mesh.write([&](const std::string& path) {
    ThreadLimit(arguments.mesh.threads).run([&] {
      if (files::is_surface_format(arguments.output, arguments.output_format))
        files::write_surface(path, files::surface_of(run.result.mesh, arguments.output),
                             arguments.output_format);
      else
        io::write_tet_mesh(path, run.result.mesh, run.split ? run.split->interfaces : Interfaces(),
                           arguments.output_format, arguments.ghost_cells);
    });
  });
  run.times.end();
  std::vector<process::StagedFile*> files{&mesh};
  std::deque<process::StagedFile> reports;
  for (const std::string& target : arguments.reports) {
    reports.emplace_back(process.files, target).write([&](const std::string& path) {
      write_report(path, arguments, run, shown);
    });
    files.push_back(&reports.back());
  }
  std::optional<process::StagedFile> decomposition;
  if (!arguments.cell_decomposition.empty()) {
    decomposition.emplace(process.files, arguments.cell_decomposition);
    decomposition->write(
        [&](const std::string& path) { files::write_cell_decomposition(path, run.result.mesh); });
    files.push_back(&*decomposition);
  }
  const auto trace = staged_trace(process, arguments, run.trace);
  files.push_back(trace.get());
  process.files.commit(files);
}

/// Checks the trace folder before long work starts.
void require_trace_folder(process::Process& process, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw WriteError(fmt::format("{}: cannot be made: {}", folder, error.message()));
  process.files.require_writable(files::trace_file(folder));
}

}  // namespace

void tell_of(const process::Console& console, const MeshArguments& arguments, const report::MeshRun& run) {
  if (run.result.status == MeshStatus::guarantee_missed)
    console.tell("collarmesh: {}a guarantee is missed: {}\n", arguments.quiet ? arguments.output + ": " : "",
                 run.result.message);
  constexpr std::size_t most = 10;
  const std::size_t findings = arguments.verbose ? run.check.findings.size() : most,
                    straightened = arguments.verbose ? run.second_order.straightened.size() : most;
  const std::string wrong =
      report::findings_text(run.check, findings) + report::straightened_text(run.second_order, straightened);
  console.tell("{}", arguments.quiet ? each_line_of(arguments.output, wrong) : wrong);
  if (arguments.quiet) return;
  for (const std::string& warning : run.check.warnings) console.tell("warning: {}\n", warning);
  console.tell("{}", report::run_text(arguments, run));
  if (arguments.tell_losses)
    console.tell("{}", report::losses_text(report::lost_by(
                           io::format_of(arguments.output, arguments.output_format), run.result.mesh)));
}

std::unique_ptr<files::ComplexInput> read_inputs(process::Process& process, const MeshArguments& arguments) {
  return std::make_unique<files::ComplexInput>(
      arguments.inputs, interruptible(process, files::reading_for_mesh(arguments, arguments.input_format)));
}

MadeMesh make_mesh(process::Process& process, const MeshArguments& arguments) {
  MadeMesh made;
  Stages stages(process, progress_of(arguments), made.run.times);
  stages.begin("read", 0, 0.02);
  made.input = read_inputs(process, arguments);
  made.repair = mesh(process, arguments, *made.input, stages, made.run);
  return made;
}

ExitCode make_and_write(process::Process& process, const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make) {
  process.interrupts.set_time_limit(arguments.mesh.time_limit);
  process::limit_memory(arguments.mesh.max_memory);
  process.files.require_writable(arguments.output,
                                 files::files_written(arguments.output, arguments.output_format));
  io::require_place_for_interfaces(arguments.output, arguments.split, arguments.output_format);
  for (const std::string& report : arguments.reports) process.files.require_writable(report);
  if (!arguments.cell_decomposition.empty()) process.files.require_writable(arguments.cell_decomposition);
  require_trace_folder(process, arguments.trace_folder);
  if (arguments.partitions > 0) require_partitioner();  // fail before long work, not after it
  report::MeshRun run;
  {
    Stages stages(process, progress_of(arguments), run.times);
    stages.begin("read", 0, 0.02);
    make(stages, run);
    write_files(process, arguments, stages, run);
  }
  tell_of(process.console, arguments, run);
  return run.guarantees_hold() ? ExitCode::success : ExitCode::guarantee_missed;
}

ExitCode mesh_command(process::Process& process, const MeshArguments& arguments) {
  return make_and_write(process, arguments, [&](Stages& stages, report::MeshRun& run) {
    const std::unique_ptr<files::ComplexInput> input = read_inputs(process, arguments);
    mesh(process, arguments, *input, stages, run);
  });
}

}  // namespace collarmesh::cli
