#include "commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "collarmesh/error.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/partition.h"
#include "command/interruptible.h"
#include "common/thread_limit.h"
#include "files/cell_decomposition.h"
#include "files/complex_input.h"
#include "files/file_groups.h"
#include "files/input_files.h"
#include "files/surface_files.h"
#include "io/file_format.h"
#include "report/conversion_report.h"
#include "report/report.h"
#include "report/soup_output.h"
#include "scale.h"

namespace collarmesh::cli {

namespace {

void tell_unless_quiet(const process::Console& console, const MeshArguments& a, const std::string& text) {
  if (!a.quiet) console.tell_text(text);
}

void scale_soup(PolygonSoup& soup, double factor) {
  scale(soup.points, factor);
  scale(soup.hole_points, factor);
  for (auto& region : soup.region_points) {
    region.point = {factor * region.point.x, factor * region.point.y, factor * region.point.z};
    region.size *= factor;
  }
  for (auto& hole : soup.facet_holes)
    hole.point = {factor * hole.point.x, factor * hole.point.y, factor * hole.point.z};
}

void write_soup(process::Process& process, const MeshArguments& a, const std::vector<PolygonSoup>& soups) {
  report::MergedSoup merged = report::merge_for_output(soups, a.output, a.output_format, a.complex);
  scale_soup(merged.soup, a.scale);
  process.interrupts.stop_if_asked();
  process::StagedFile file(process.files, a.output);
  file.write([&](const std::string& path) { files::write_surface(path, merged.soup, a.output_format); });
  process.files.commit({&file});
  tell_unless_quiet(process.console, a, merged.told);
}

/// Divides the mesh as --partitions says; without this option the mesh keeps the partitions of the input.
void divide(const MeshArguments& a, TetMesh& mesh) {
  if (a.partitions > 0) partition(mesh, a.partitions);
  const char* const option = a.ghost_cells != GhostCells::off ? "--ghost-cells"
                             : !a.cell_decomposition.empty()  ? "--cell-decomposition"
                                                              : nullptr;
  if (option != nullptr && mesh.tet_partition.empty())
    throw OptionError(fmt::format("{}: {} is not partitioned; say into how many parts with --partitions",
                                  option, a.inputs.front()));
}

void convert_mesh(process::Process& process, const MeshArguments& a, TetMesh& mesh) {
  if (a.inputs.size() > 1)
    throw OptionError(fmt::format("{} is a mesh; convert takes a mesh as its only input", a.inputs.front()));
  if (files::is_surface_format(a.output, a.output_format)) {
    write_soup(process, a, {files::surface_of(mesh, a.inputs.front())});
    return;
  }
  scale(mesh, a.scale);
  divide(a, mesh);
  process.interrupts.stop_if_asked();
  process::StagedFile file(process.files, a.output);
  file.write([&](const std::string& path) {
    ThreadLimit(a.mesh.threads).run([&] { io::write_tet_mesh(path, mesh, a.output_format, a.ghost_cells); });
  });
  std::optional<process::StagedFile> decomposition;
  if (!a.cell_decomposition.empty()) {
    decomposition.emplace(process.files, a.cell_decomposition);
    decomposition->write([&](const std::string& path) { files::write_cell_decomposition(path, mesh); });
  }
  process.files.commit({&file, decomposition ? &*decomposition : nullptr});
  tell_unless_quiet(
      process.console, a,
      report::tet_mesh_text(a.output, mesh) + report::partitions_text(measure_partitions(mesh)));
  tell_unless_quiet(process.console, a,
                    report::losses_text(report::lost_by(io::format_of(a.output, a.output_format), mesh)));
}

/// Repairs the input so that it forms a complex with at least one region. Throws PlcError if that is
/// impossible.
void repair(process::Process& process, const MeshArguments& a, files::ComplexInput& input) {
  const Plc plc = input.build(a.complex, a.repair);
  process.console.tell("{}{}", report::warnings_text(plc), report::repair_text(input.repaired(), a.quiet));
}

}  // namespace

ExitCode convert_command(process::Process& process, const ConvertArguments& a) {
  process.files.require_writable(a.output, files::files_written(a.output, a.output_format));
  if (!a.cell_decomposition.empty()) process.files.require_writable(a.cell_decomposition);
  const bool to_surface = files::is_surface_format(a.output, a.output_format);
  std::optional<TetMesh> mesh = files::read_mesh_if_there(a.inputs.front(), a.input_format);
  const bool from_mesh = mesh.has_value();
  if ((to_surface || from_mesh) && !a.meshing_options.empty())
    process.console.tell("warning: {}: no effect, since nothing is meshed here.\n",
                         fmt::join(a.meshing_options, " "));
  if (from_mesh) {
    convert_mesh(process, a, *mesh);
    return ExitCode::success;
  }
  if (!to_surface) return mesh_command(process, a);
  files::ComplexInput input(a.inputs, interruptible(process, files::reading_of(a, a.input_format)));
  if (a.repairs) repair(process, a, input);
  write_soup(process, a, input.soups());
  return ExitCode::success;
}

}  // namespace collarmesh::cli
