#include "commands.h"

#include <fmt/format.h>

#include <optional>

#include "collarmesh/error.h"
#include "command/interruptible.h"
#include "files/complex_input.h"
#include "files/file_groups.h"
#include "files/surface_files.h"
#include "report/json_text.h"
#include "report/report.h"
#include "report/soup_output.h"

namespace collarmesh::cli {

namespace {

/// Reads the written file again. Returns a warning if it is no valid complex: some formats drop digits of
/// coordinates, or the regions beside interfaces.
std::string read_again(const std::string& path, const RepairArguments& a) {
  try {
    const PolygonSoup soups[] = {files::read_surface(path, a.output_format)};
    build_plc(soups, a.complex);
  } catch (const PlcError& error) {
    return fmt::format(
        "warning: the written file is not a valid complex, because its format does not store all data: {} "
        "Write .off, .obj or .ply, which store all digits of coordinates, or .poly, which also stores "
        "regions.\n",
        error.what());
  }
  return {};
}

std::string repairs_text(const RepairReport& report, const RepairArguments& a) {
  if (report.repaired || a.quiet) return report::repair_text(report, a.quiet);
  return "valid: nothing had to be repaired, the input is written as it is\n";
}

}  // namespace

ExitCode repair_command(process::Process& process, const RepairArguments& a) {
  process.files.require_writable(a.output, files::files_written(a.output, a.output_format));
  for (const std::string& report : a.reports) process.files.require_writable(report);
  process.interrupts.note_stage({.stage = "read"});
  files::ComplexInput input(a.inputs, interruptible(process, files::reading_of(a, a.input_format)));
  process.interrupts.note_stage({.stage = "complex"});
  const Plc plc = input.build(a.complex, a.repair);
  process.interrupts.stop_if_asked();
  const nlohmann::ordered_json told =
      report::repair_run_json(a, plc, summarize(plc, a.mesh.bounds.crease_angle), input.repaired());
  const report::MergedSoup merged =
      report::merge_for_output(input.soups(), a.output, a.output_format, a.complex);
  std::string warning;
  process::StagedFile surface(process.files, a.output);
  surface.write([&](const std::string& path) {
    files::write_surface(path, merged.soup, a.output_format);
    warning = read_again(path, a);
  });
  std::optional<process::StagedFile> report;
  if (!a.reports.empty()) {
    report.emplace(process.files, a.reports.front());
    report->write(
        [&](const std::string& path) { process::write_text(path, report::json_text(told, 1) + "\n"); });
  }
  process.files.commit({&surface, report ? &*report : nullptr});
  process.console.tell("{}{}{}{}", report::warnings_text(plc), repairs_text(input.repaired(), a),
                       a.quiet ? "" : merged.told, warning);
  if (a.json) process.console.print_result(report::json_text(told, 1) + "\n");
  return ExitCode::success;
}

}  // namespace collarmesh::cli
