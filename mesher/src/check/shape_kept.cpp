// Measures volumes, areas and lengths of the mesh and of the input, and compares the volumes.
#include <cassert>
#include <cmath>
#include <string>

#include "check/feature_sizes.h"
#include "check/guarantees.h"
#include "check/mesh_to_check.h"

namespace collarmesh::checks {

namespace {

double volume_below_face(const TetMesh& mesh, const Point& apex, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return mesh.order() == 1 ? six_volume(apex, mesh.points[a], mesh.points[b], mesh.points[c]) / 6
                           : volume_below(apex, curved_face(mesh, face));
}

/// Returns a point of the shell in the complex, as an apex for volumes: with an apex far away, small volumes
/// would be lost in cancellation.
Point point_of(const Plc& plc, const Shell& shell) {
  return plc.points[plc.triangles[plc.patches[shell.patches[0]].first_triangle].points[0]];
}

std::vector<double> enclosed_by(const std::vector<Shell>& shells, const MeshToCheck& to_check) {
  const TetMesh& mesh = to_check.mesh;
  const Grouping faces(to_check.match.face_patch, to_check.plc.patches.size());
  std::vector<double> volumes;
  for (const Shell& shell : shells) {
    const Point apex = point_of(to_check.plc, shell);
    double volume = 0;
    for (const Index patch : shell.patches)
      for (const Index* face = faces.begin(patch); face != faces.end(patch); ++face)
        volume +=
            volume_below_face(mesh, apex, *face) * (mesh.face_regions[*face][0] == shell.region ? 1 : -1);
    volumes.push_back(std::fabs(volume));
  }
  return volumes;
}

/// Compares a volume in the mesh (`made`) with that in the input. Adds a finding or a warning if they differ
/// too much.
void judge_volume(const MeshToCheck& to_check, const std::string& what, double made, double input,
                  const Point& where, Index id, CheckReport& report, Findings& findings) {
  const double largest = volume_allowance(to_check.mesh.order()), off = std::fabs(made - input);
  if (!(off > std::min(volume_warned_of, largest) * input)) return;
  const std::string found =
      fmt::format("{} has a volume of {:.6g} in the mesh and of {:.6g} in the input, {:+.2f} %", what, made,
                  input, percent_off(made, input));
  if (off > largest * input && to_check.options.bounds.distance <= 0)
    findings.add(guarantee::volume_kept, where, {id},
                 "{}; allowed are {:.0f} %. Ask for a smaller size or distance.", found, 100 * largest);
  else
    report.warnings.push_back(found + "; a smaller size or distance reduces the difference.");
}

/// Names a closed surface by its first patches.
std::string name_of(const Plc& plc, const Shell& shell) {
  constexpr std::size_t listed = 5;
  std::string tags;
  for (std::size_t i = 0; i < std::min(listed, shell.patches.size()); ++i)
    tags += fmt::format("{}{}", i == 0 ? "" : ", ", plc.patches[shell.patches[i]].tag);
  const Point where = point_of(plc, shell);
  return fmt::format(
      "The {} inside the closed surface of the patches with tags {}{}, at ({:.6g}, {:.6g}, {:.6g}),",
      shell.region == 0 ? "shape or void" : "part", tags, shell.patches.size() > listed ? ", ..." : "",
      where.x, where.y, where.z);
}

}  // namespace

void check_shape_kept(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  assert(to_check.is_matched() && report.region_volumes.size() == to_check.plc.regions.size());
  const Plc& plc = to_check.plc;
  report.of_input = input_sizes(to_check);
  const std::vector<Shell> shells = shells_of(plc);
  report.of_mesh = feature_sizes(to_check);
  report.of_mesh.volumes = report.region_volumes;
  report.of_mesh.shells = enclosed_by(shells, to_check);
  for (Index r = 1; r < plc.regions.size(); ++r)
    judge_volume(to_check, fmt::format("Region {} (tag {})", r, plc.regions[r].tag),
                 report.of_mesh.volumes[r], report.of_input.volumes[r], plc.bounds.centre(), r, report,
                 findings);
  for (std::size_t i = 0; i < shells.size(); ++i)
    judge_volume(to_check, name_of(plc, shells[i]), report.of_mesh.shells[i], report.of_input.shells[i],
                 point_of(plc, shells[i]), shells[i].region, report, findings);
}

}  // namespace collarmesh::checks
