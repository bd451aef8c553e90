// Volumes, areas and lengths of the mesh beside those of the input.
#include <cmath>

#include "check/subject.h"

namespace collarmesh::checks {

namespace {

double length_of_edge(const TetMesh& mesh, Index edge) {
  const auto& [a, b] = mesh.edges[edge];
  if (mesh.order() == 1) return distance(mesh.points[a], mesh.points[b]);
  return length(CurvedEdge{mesh.points[a], mesh.points[b], mesh.points[mesh.edge_mid_nodes[edge]]});
}

double area_of_face(const TetMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  const Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
  if (mesh.order() == 1) return 0.5 * norm(cross(q - p, r - p));
  const auto& [pq, qr, rp] = mesh.face_mid_nodes[face];
  return area(CurvedTriangle{p, q, r, mesh.points[pq], mesh.points[qr], mesh.points[rp]});
}

ShapeMeasures measures_of(const Subject& subject, const std::vector<double>& volumes) {
  const TetMesh& mesh = subject.mesh;
  ShapeMeasures measures{volumes, std::vector<double>(subject.plc.patches.size(), 0),
                         std::vector<double>(subject.plc.curves.size(), 0)};
  for (Index face = 0; face < mesh.faces.size(); ++face)
    if (const Index patch = subject.match.face_patch[face]; patch != none)
      measures.areas[patch] += area_of_face(mesh, face);
  for (Index edge = 0; edge < mesh.edges.size(); ++edge)
    if (const Index curve = subject.match.edge_curve[edge]; curve != none)
      measures.lengths[curve] += length_of_edge(mesh, edge);
  return measures;
}

/// Replaces values of the complex by exact ones where these are known.
void take_exact(const std::vector<double>& exact, std::vector<double>& values) {
  for (std::size_t i = 0; i < std::min(exact.size(), values.size()); ++i)
    if (std::isfinite(exact[i])) values[i] = exact[i];
}

}  // namespace

void check_shape_kept(const Subject& subject, CheckReport& report, Findings& findings) {
  constexpr double warned_of = 0.02;
  const Plc& plc = subject.plc;
  report.of_input = collarmesh::measures_of(plc);
  take_exact(subject.options.exact.volumes, report.of_input.volumes);
  take_exact(subject.options.exact.areas, report.of_input.areas);
  take_exact(subject.options.exact.lengths, report.of_input.lengths);
  report.of_mesh = measures_of(subject, report.region_volumes);
  const double largest = volume_allowance(subject.mesh.order());
  const bool asked_for = subject.options.bounds.distance > 0;
  for (Index r = 1; r < plc.regions.size(); ++r) {
    const double input = report.of_input.volumes[r], made = report.of_mesh.volumes[r];
    const double off = std::fabs(made - input);
    const std::string found = fmt::format(
        "Region {} (tag {}) has a volume of {:.6g} in the mesh and of {:.6g} in the input, {:+.2f} %", r,
        plc.regions[r].tag, made, input, percent_off(made, input));
    if (off > largest * input && !asked_for)
      findings.add(guarantee::volume_kept, plc.bounds.centre(), {r},
                   "{}; allowed are {:.0f} %. Ask for a smaller size or distance.", found, 100 * largest);
    else if (off > std::min(warned_of, largest) * input)
      report.warnings.push_back(found + "; a smaller size or distance brings it nearer.");
  }
}

}  // namespace collarmesh::checks
