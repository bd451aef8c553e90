// Checks that the complex's vertices are in the mesh, and that points lie on the features that the mesh gives
// for them.
#include "check/mesh_to_check.h"

#include <cassert>

namespace collarmesh::checks {

namespace {

// The features of one dimension that each mesh point lies on: none, exactly one, or several.
class FeatureOfPoint {
 public:
  explicit FeatureOfPoint(std::size_t points) : feature_(points, none), several_(points, false) {}

  void add(Index point, Index feature) {
    if (feature_[point] != none && feature_[point] != feature) several_[point] = true;
    feature_[point] = feature;
  }
  bool any(Index point) const { return feature_[point] != none; }
  bool only(Index point, Index feature) const { return feature_[point] == feature && !several_[point]; }

 private:
  std::vector<Index> feature_;
  std::vector<bool> several_;
};

}  // namespace

void check_vertices_present(const MeshToCheck& to_check, Findings& findings) {
  assert(to_check.match.vertex_point.size() == to_check.plc.vertices.size());
  const Plc& plc = to_check.plc;
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const Point& where = plc.points[plc.vertices[v].point];
    if (to_check.match.vertex_point[v] != none || vertex_is_outside(to_check, v)) continue;
    findings.add(guarantee::vertex_present, where, {v},
                 "Vertex {} of the complex at {} is not a point of the mesh; a feature was lost there.", v,
                 At{where});
  }
}

void check_vertices(const MeshToCheck& to_check, Findings& findings) {
  assert(to_check.is_matched());
  check_vertices_present(to_check, findings);
  const TetMesh& mesh = to_check.mesh;
  if (mesh.features.empty()) return;
  FeatureOfPoint vertices(mesh.points.size()), curves(mesh.points.size()), patches(mesh.points.size());
  const FeatureMatch& match = to_check.match;
  for (Index v = 0; v < match.vertex_point.size(); ++v)
    if (match.vertex_point[v] != none) vertices.add(match.vertex_point[v], v);
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    if (match.edge_curve[e] == none) continue;
    for (const Index p : mesh.edges[e]) curves.add(p, match.edge_curve[e]);
    if (mesh.order() == 2) curves.add(mesh.edge_mid_nodes[e], match.edge_curve[e]);
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (match.face_patch[f] == none) continue;
    for (const Index p : mesh.faces[f]) patches.add(p, match.face_patch[f]);
    if (mesh.order() == 2)
      for (const Index p : mesh.face_mid_nodes[f]) patches.add(p, match.face_patch[f]);
  }
  for (Index p = 0; p < mesh.points.size(); ++p) {
    const auto [dimension, feature] = mesh.features[p];
    if (dimension < 3 && feature == none) continue;  // the mesh does not know the feature
    const bool holds = dimension == 0    ? vertices.only(p, feature)
                       : vertices.any(p) ? false
                       : dimension == 1  ? curves.only(p, feature)
                       : curves.any(p)   ? false
                       : dimension == 2  ? patches.only(p, feature)
                                         : !patches.any(p);
    if (holds) continue;
    findings.add(guarantee::vertex_feature, mesh.points[p], {p},
                 "Point {} at {} is marked as a point of feature {} of dimension {}, but the vertices, edges "
                 "and faces there contradict that; correct its feature.",
                 p, At{mesh.points[p]}, dimension == 3 ? "none" : std::to_string(feature),
                 static_cast<unsigned>(dimension));
  }
}

}  // namespace collarmesh::checks
