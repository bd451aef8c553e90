// What has to hold before anything else can be looked at.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "check/subject.h"

namespace collarmesh::checks {

namespace {

void check_length(std::size_t length, std::size_t expected, const char* array, const char* of,
                  Findings& findings) {
  if (length != expected)
    findings.add(guarantee::valid_arrays, {}, {}, "The mesh has {} {} for {} {}; give one for each.", length,
                 array, expected, of);
}

template <std::size_t n>
void check_corners(const std::vector<std::array<Index, n>>& entities, const TetMesh& mesh, const char* kind,
                   Findings& findings) {
  for (Index i = 0; i < entities.size(); ++i)
    for (std::size_t k = 0; k < n; ++k) {
      const Index corner = entities[i][k];
      const bool repeated =
          std::find(entities[i].begin(), entities[i].begin() + k, corner) != entities[i].begin() + k;
      if (corner < mesh.points.size() && !repeated) continue;
      const Point where = corner < mesh.points.size() ? mesh.points[corner] : Point{};
      findings.add(guarantee::valid_arrays, where, {i},
                   "{} {} has point {} as corner {}{}; the mesh has {} points. Its writer is at fault.", kind,
                   i, corner, k, repeated ? " again" : "", mesh.points.size());
    }
}

// `optional`: none stands for an unknown one.
void check_range(const std::vector<Index>& values, std::size_t first, std::size_t end, bool optional,
                 const char* of, const char* value, Findings& findings) {
  for (Index i = 0; i < values.size(); ++i)
    if ((values[i] < first || values[i] >= end) && !(optional && values[i] == none))
      findings.add(
          guarantee::valid_arrays, {}, {i},
          "{} {} has {} {}, the complex has {} to {}; check the mesh against the complex it was made from.",
          of, i, value, values[i], first, static_cast<std::ptrdiff_t>(end) - 1);
}

void check_face_regions(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  for (Index f = 0; f < mesh.face_regions.size(); ++f)
    for (const Index region : mesh.face_regions[f])
      if (region >= plc.regions.size())
        findings.add(
            guarantee::valid_arrays, {}, {f},
            "Face {} has region {} on a side, the complex has 0 to {}; check the mesh against the complex it "
            "was made from.",
            f, region, static_cast<std::ptrdiff_t>(plc.regions.size()) - 1);
}

void check_lengths(const TetMesh& mesh, Findings& findings) {
  if (!mesh.features.empty())
    check_length(mesh.features.size(), mesh.points.size(), "features", "points", findings);
  check_length(mesh.tet_region.size(), mesh.tets.size(), "regions", "tets", findings);
  check_length(mesh.tet_tag.size(), mesh.tets.size(), "tags", "tets", findings);
  check_length(mesh.tet_collar.size(), mesh.tets.size(), "collar marks", "tets", findings);
  check_length(mesh.tet_crease.size(), mesh.tets.size(), "tags of creases", "tets", findings);
  if (!mesh.tet_thin.empty())
    check_length(mesh.tet_thin.size(), mesh.tets.size(), "marks of thin tets", "tets", findings);
  check_length(mesh.face_regions.size(), mesh.faces.size(), "pairs of regions", "faces", findings);
  check_length(mesh.face_patch.size(), mesh.faces.size(), "patches", "faces", findings);
  check_length(mesh.face_tag.size(), mesh.faces.size(), "tags", "faces", findings);
  check_length(mesh.edge_curve.size(), mesh.edges.size(), "curves", "edges", findings);
  check_length(mesh.edge_tag.size(), mesh.edges.size(), "tags", "edges", findings);
  if (mesh.order() == 1) return;
  check_length(mesh.tet_mid_nodes.size(), mesh.tets.size(), "lists of mid nodes", "tets", findings);
  check_length(mesh.face_mid_nodes.size(), mesh.faces.size(), "lists of mid nodes", "faces", findings);
  check_length(mesh.edge_mid_nodes.size(), mesh.edges.size(), "mid nodes", "edges", findings);
}

void check_features(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  const std::size_t counts[] = {plc.vertices.size(), plc.curves.size(), plc.patches.size()};
  for (Index i = 0; i < mesh.features.size(); ++i) {
    const auto [dimension, feature] = mesh.features[i];
    if (dimension > 3 || (dimension < 3 && feature != none && feature >= counts[dimension]))
      findings.add(
          guarantee::valid_arrays, {}, {i},
          "Point {} names the feature {} of dimension {}, which the complex does not have; check the mesh "
          "against the complex it was made from.",
          i, feature, static_cast<unsigned>(dimension));
  }
}

struct PlacedPoint {
  double x, y, z;
  Index index;

  auto place() const { return std::tie(x, y, z); }
};

void check_distinct(const TetMesh& mesh, Findings& findings) {
  std::vector<PlacedPoint> points;
  points.reserve(mesh.points.size());
  for (Index i = 0; i < mesh.points.size(); ++i)
    points.push_back({mesh.points[i].x, mesh.points[i].y, mesh.points[i].z, i});
  std::sort(points.begin(), points.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    return a.place() != b.place() ? a.place() < b.place() : a.index < b.index;
  });
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Index first = points[i - 1].index, second = points[i].index;
    if (points[i - 1].place() == points[i].place())
      findings.add(guarantee::distinct_points, mesh.points[first], {first, second},
                   "Points {} and {} are both at {}; the mesh is cut open or doubled there, merge them.",
                   first, second, At{mesh.points[first]});
  }
}

void check_referenced(const TetMesh& mesh, Findings& findings) {
  std::vector<bool> referenced(mesh.points.size(), false);
  for (const auto& t : mesh.tets)
    for (const Index p : t) referenced[p] = true;
  for (const auto& t : mesh.tet_mid_nodes)
    for (const Index p : t) referenced[p] = true;
  for (Index i = 0; i < mesh.points.size(); ++i)
    if (!referenced[i])
      findings.add(guarantee::referenced_points, mesh.points[i], {i},
                   "Point {} at {} is a node of no tet; leave it out of the mesh.", i, At{mesh.points[i]});
}

void check_collar_balls(const TetMesh& mesh, Findings& findings) {
  for (Index b = 0; b < mesh.collar_balls.size(); ++b) {
    const auto& [point, radius, centre] = mesh.collar_balls[b];
    const bool on_crease = point < mesh.points.size() && point < mesh.features.size() &&
                           mesh.features[point].dimension < 2 && mesh.features[point].feature != none;
    const bool is_finite = std::isfinite(radius) && std::isfinite(centre.x) && std::isfinite(centre.y) &&
                           std::isfinite(centre.z);
    if (!on_crease || !is_finite || !(radius > 0))
      findings.add(
          guarantee::valid_arrays, {}, {b},
          "Ball {} of a collar is centred at point {} with radius {:.6g}; it must be a point on a vertex "
          "or curve, and the radius positive and finite, as its coordinates.",
          b, point, radius);
  }
}

}  // namespace

bool check_arrays(const TetMesh& mesh, Findings& findings) {
  const std::size_t before = findings.total();
  check_lengths(mesh, findings);
  check_corners(mesh.tets, mesh, "Tet", findings);
  check_corners(mesh.faces, mesh, "Face", findings);
  check_corners(mesh.edges, mesh, "Edge", findings);
  check_corners(mesh.tet_mid_nodes, mesh, "Mid nodes of tet", findings);
  check_corners(mesh.face_mid_nodes, mesh, "Mid nodes of face", findings);
  return findings.total() == before;
}

bool check_labels(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  const std::size_t before = findings.total();
  check_range(mesh.tet_region, 1, plc.regions.size(), false, "Tet", "region", findings);
  check_face_regions(mesh, plc, findings);
  check_range(mesh.face_patch, 0, plc.patches.size(), true, "Face", "patch", findings);
  check_range(mesh.edge_mid_nodes, 0, mesh.points.size(), false, "Edge", "mid node", findings);
  check_range(mesh.edge_curve, 0, plc.curves.size(), true, "Edge", "curve", findings);
  check_features(mesh, plc, findings);
  check_collar_balls(mesh, findings);
  return findings.total() == before;
}

bool check_points(const Subject& subject, Findings& findings) {
  const TetMesh& mesh = subject.mesh;
  bool finite = true;
  for (Index i = 0; i < mesh.points.size(); ++i) {
    const Point& p = mesh.points[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    finite = false;
    findings.add(guarantee::finite_points, {}, {i},
                 "Point {} has the coordinates {}; every one must be finite.", i, At{p});
  }
  if (!finite) return false;
  check_distinct(mesh, findings);
  check_referenced(mesh, findings);
  return true;
}

}  // namespace collarmesh::checks
