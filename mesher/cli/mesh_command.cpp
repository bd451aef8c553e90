#include "commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <optional>

#include "collarmesh/error.h"
#include "collarmesh/io/interfaces_io.h"
#include "collarmesh/partition.h"
#include "command/make_mesh.h"
#include "command/usable.h"
#include "common/thread_limit.h"
#include "files/cell_decomposition.h"
#include "files/file_groups.h"
#include "files/surface_files.h"
#include "files/trace_files.h"
#include "io/file_format.h"
#include "report/conversion_report.h"
#include "report/html_report.h"
#include "report/json_text.h"
#include "report/report.h"
#include "scale.h"

namespace collarmesh::cli {

namespace {

/// The data that HTML reports show, in the input's unit of length.
struct Shown {
  report::ShownMesh mesh;
  std::vector<report::ShownStep> trace;
};

/// Writes a report, as HTML or JSON. HTML reports need `shown`.
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

/// Creates the trace folder and checks that it can be written to, before long work starts.
void require_trace_folder(process::Process& process, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw WriteError(fmt::format("{}: cannot be made: {}", folder, error.message()));
  process.files.require_writable(files::trace_file(folder));
}

/// Prints the problems of a mesh to standard error and, unless quiet, its summary.
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

/// Throws Stopped if the certificate found an element that no solver can use. Prints the findings and writes
/// the trace before it throws.
void require_usable(process::Process& process, const MeshArguments& arguments, Stages& stages,
                    const report::MeshRun& run) {
  const auto tell = [&] {
    constexpr std::size_t most = 10;
    const std::string wrong =
        report::findings_text(run.check, arguments.verbose ? run.check.findings.size() : most);
    stages.print(arguments.quiet ? each_line_of(arguments.output, wrong) : wrong);
    if (const auto trace = staged_trace(process, arguments, run.trace)) process.files.commit({trace.get()});
  };
  for (const Finding& finding : run.check.findings)
    command::require_usable(finding.guarantee, finding.message, tell);
}

}  // namespace

ExitCode make_and_write(process::Process& process, const MeshArguments& arguments,
                        const std::function<void(Stages&, report::MeshRun&)>& make) {
  process.files.require_writable(arguments.output,
                                 files::files_written(arguments.output, arguments.output_format));
  io::require_place_for_interfaces(arguments.output, arguments.split, arguments.output_format);
  for (const std::string& report : arguments.reports) process.files.require_writable(report);
  if (!arguments.cell_decomposition.empty()) process.files.require_writable(arguments.cell_decomposition);
  require_trace_folder(process, arguments.trace_folder);
  if (arguments.partitions > 0) require_partitioner();  // fail before long work, not after it
  report::MeshRun run;
  {
    Stages stages(process, arguments, run.times);
    stages.begin("read", 0, 0.02);
    make(stages, run);
    if (!arguments.keep_invalid) require_usable(process, arguments, stages, run);
    write_files(process, arguments, stages, run);
  }
  tell_of(process.console, arguments, run);
  return run.guarantees_hold() ? ExitCode::success : ExitCode::guarantee_missed;
}

ExitCode mesh_command(process::Process& process, const MeshArguments& arguments) {
  return make_and_write(process, arguments, [&](Stages& stages, report::MeshRun& run) {
    const std::unique_ptr<files::ComplexInput> input = read_inputs(process, arguments);
    make_mesh(process, arguments, *input, stages, run);
  });
}

}  // namespace collarmesh::cli
