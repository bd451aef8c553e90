#include "check/feature_sizes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/edge_key.h"
#include "common/median.h"
#include "common/round_curves.h"
#include "common/sort_uniquely.h"

namespace collarmesh::checks {

namespace {

/// Replaces values, measured in the complex, by exact values where these are known (finite).
void take_exact(const std::vector<double>& exact, std::vector<double>& values) {
  for (std::size_t i = 0; i < std::min(exact.size(), values.size()); ++i)
    if (std::isfinite(exact[i])) values[i] = exact[i];
}

/// Returns the lengths of the sides of faces, each side once (dimension 2), or of the edges (dimension 1), as
/// if they were straight.
std::vector<double> lengths_of_sides(const TetMesh& mesh, int dimension) {
  std::vector<double> lengths;
  const auto add = [&](Index a, Index b) { lengths.push_back(distance(mesh.points[a], mesh.points[b])); };
  if (dimension == 1) {
    for (const auto& [a, b] : mesh.edges) add(a, b);
    return lengths;
  }
  std::vector<std::uint64_t> sides;
  for (const auto& f : mesh.faces)
    for (unsigned i = 0; i < 3; ++i) sides.push_back(edge_key(f[i], f[(i + 1) % 3]));
  sort_uniquely(sides);
  lengths.reserve(sides.size());
  for (const std::uint64_t side : sides)
    add(static_cast<Index>(side >> 32U), static_cast<Index>(side & 0xffffffffU));
  return lengths;
}

}  // namespace

CurvedTriangle curved_face(const TetMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  const auto& [ab, bc, ca] = mesh.face_mid_nodes[face];
  return {mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[ab], mesh.points[bc], mesh.points[ca]};
}

double length_of_edge(const TetMesh& mesh, Index edge) {
  const auto& [a, b] = mesh.edges[edge];
  if (mesh.order() == 1) return distance(mesh.points[a], mesh.points[b]);
  return length(CurvedEdge{mesh.points[a], mesh.points[b], mesh.points[mesh.edge_mid_nodes[edge]]});
}

double area_of_face(const TetMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return mesh.order() == 1 ? area(mesh.points[a], mesh.points[b], mesh.points[c])
                           : collarmesh::area(curved_face(mesh, face));
}

ShapeMeasures feature_sizes(const MeshToCheck& to_check) {
  assert(to_check.is_matched());
  const TetMesh& mesh = to_check.mesh;
  ShapeMeasures sizes{{},
                      std::vector<double>(to_check.plc.patches.size(), 0),
                      std::vector<double>(to_check.plc.curves.size(), 0),
                      {}};
  for (Index face = 0; face < mesh.faces.size(); ++face)
    if (const Index patch = to_check.match.face_patch[face]; patch != none)
      sizes.areas[patch] += area_of_face(mesh, face);
  for (Index edge = 0; edge < mesh.edges.size(); ++edge)
    if (const Index curve = to_check.match.edge_curve[edge]; curve != none)
      sizes.lengths[curve] += length_of_edge(mesh, edge);
  return sizes;
}

AllowedArea planar_area(const MeshToCheck& to_check, Index patch) {
  const Plc& plc = to_check.plc;
  const Plc::Patch& on = plc.patches[patch];
  long double sum = 0;
  for (Index t = on.first_triangle; t < on.first_triangle + on.triangle_count; ++t) {
    const auto& [a, b, c] = plc.triangles[t].points;
    sum += 0.5 * dot(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]), on.normal);
  }
  const double area = std::fabs(static_cast<double>(sum));
  double allowed = 1e-9 * area;
  for (const Index c : on.curves) allowed += to_check.curve_allowance[c] * length_of(plc, plc.curves[c]);
  return {area, allowed};
}

ShapeMeasures input_sizes(const MeshToCheck& to_check) {
  ShapeMeasures sizes = measures_of(to_check.plc);
  const ShapeMeasures& exact = to_check.options.exact;
  take_exact(exact.volumes, sizes.volumes);
  take_exact(exact.areas, sizes.areas);
  take_exact(exact.lengths, sizes.lengths);
  return sizes;
}

void measure_without_tets(const MeshToCheck& to_check, int dimension, CheckReport& report) {
  report.of_input = input_sizes(to_check);
  report.of_mesh = feature_sizes(to_check);
  for (ShapeMeasures* sizes : {&report.of_input, &report.of_mesh}) {
    sizes->volumes.clear();
    sizes->shells.clear();
    if (dimension == 1) sizes->areas.clear();
  }
  std::vector<double> lengths = lengths_of_sides(to_check.mesh, dimension);
  report.median_edge = median(lengths);
}

void check_present(const MeshToCheck& to_check, int dimension, Findings& findings) {
  const Plc& plc = to_check.plc;
  const Grouping by_patch(to_check.match.face_patch, plc.patches.size()),
      by_curve(to_check.match.edge_curve, plc.curves.size());
  for (Index p = 0; dimension == 2 && p < plc.patches.size(); ++p) {
    if (by_patch.size(p) > 0) continue;
    const Point& where = to_check.plc_corner(plc.triangles[plc.patches[p].first_triangle], 0);
    findings.add(
        guarantee::patch_present, where, {p},
        "Patch {} (tag {}) at {} has no faces; it was lost, or its faces are tagged with another patch.", p,
        plc.patches[p].tag, At{where});
  }
  for (Index c = 0; c < plc.curves.size(); ++c) {
    if (by_curve.size(c) > 0 || (dimension == 2 && plc.curves[c].patches.empty())) continue;
    const Point& where = plc.points[plc.curves[c].points.front()];
    findings.add(
        guarantee::curve_present, where, {c},
        "Curve {} (tag {}) at {} has no edges; it was lost, or its edges are tagged with another curve.", c,
        plc.curves[c].tag, At{where});
  }
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const Plc::Vertex& vertex = plc.vertices[v];
    if (to_check.match.vertex_point[v] != none) continue;
    if (dimension == 2 ? vertex.patches.empty() : vertex.curves.empty()) continue;
    const Point& where = plc.points[vertex.point];
    findings.add(guarantee::vertex_present, where, {v}, "Vertex {} (tag {}) at {} is no point of the mesh.",
                 v, vertex.tag, At{where});
  }
}

}  // namespace collarmesh::checks
