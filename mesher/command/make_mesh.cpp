#include "command/make_mesh.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "collarmesh/io/size_field_io.h"
#include "command/interruptible.h"
#include "command/option_warnings.h"
#include "common/thread_limit.h"
#include "files/trace_files.h"

namespace collarmesh::command {

namespace {

PipelineOptions pipeline_options(process::Process& process, const MeshArguments& a) {
  PipelineOptions options = a;
  options.mesh.count_work = !a.reports.empty();
  options.trace = !a.trace_folder.empty();
  options.mesh.time_limit =
      process.interrupts.time_left();  // the whole run is limited, from reading to writing
  return options;
}

/// Records how far refinement came, for the message when time, memory or vertices are used up.
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

/// A builder of complexes from the input files. Prints the warnings and repairs of each complex.
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

  /// Returns a message for each source of the size field that had no effect. Call it after a mesh was made.
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
  std::shared_ptr<SizeFieldUse> size_field_use_;  // how the mesh tried last used the size field
};

}  // namespace

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

RepairOptions make_mesh(process::Process& process, const MeshArguments& arguments, files::ComplexInput& input,
                        Stages& stages, report::MeshRun& run) {
  Execution execution;
  execution.cancel = &process.interrupts.flag();
  std::optional<process::CadWork> projecting;
  execution.progress = [&](const ProgressReport& report) {
    if (!input.has_cad() || (report.phase != "project" && report.phase != "second order"))
      projecting.reset();
    else if (!projecting)
      projecting.emplace(process.supervisor, "finding the nearest points of the shape's faces and edges",
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
    if (const auto trace = staged_trace(process, arguments, run.trace)) process.files.commit({trace.get()});
    throw process::Stopped(process::ExitCode::budget_hit, run.result.message + "; nothing was written");
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

std::unique_ptr<files::ComplexInput> read_inputs(process::Process& process, const MeshArguments& arguments) {
  return std::make_unique<files::ComplexInput>(
      arguments.inputs, interruptible(process, files::reading_for_mesh(arguments, arguments.input_format)));
}

MadeMesh make_mesh(process::Process& process, const MeshArguments& arguments) {
  MadeMesh made;
  Stages stages(process, arguments, made.run.times);
  stages.begin("read", 0, 0.02);
  made.input = read_inputs(process, arguments);
  made.repair = make_mesh(process, arguments, *made.input, stages, made.run);
  return made;
}

}  // namespace collarmesh::command
