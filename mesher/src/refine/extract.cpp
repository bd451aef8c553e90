// The result of the refinement as a TetMesh.
#include <algorithm>

#include "refine/refinement.h"

namespace collarmesh {

TetMesh Refinement::extract() const {
  TetMesh mesh;
  std::vector<Index> number(mesh_.vertex_count(), none);
  const auto vertex = [&](Index v) {
    if (number[v] != none) return number[v];
    number[v] = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(frame_.outside(mesh_.point(v)));
    const MeshVertex& known = vertices_[v];
    mesh.features.push_back({known.dimension, known.dimension == 3 ? none : known.feature});
    return number[v];
  };
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || labels_[cell].region == 0 || labels_[cell].in_collar) continue;
    const auto& v = mesh_.corners(cell);
    mesh.tets.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2]), vertex(v[3])});
    mesh.tet_region.push_back(labels_[cell].region);
    mesh.tet_tag.push_back(plc_.regions[labels_[cell].region].tag);
    mesh.tet_collar.push_back(0);
    mesh.tet_crease.push_back(0);
  }
  for (const auto& tet : stitched_.tets) {
    const auto& v = tet.corners;
    mesh.tets.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2]), vertex(v[3])});
    mesh.tet_region.push_back(tet.region);
    mesh.tet_tag.push_back(plc_.regions[tet.region].tag);
    mesh.tet_collar.push_back(tet.collar);
    mesh.tet_crease.push_back(tet.crease);
  }
  mesh.tet_thin.assign(mesh.tets.size(), 0);
  for (const auto& face : stitched_.faces) {
    const auto& v = face.corners;
    mesh.faces.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2])});
    mesh.face_regions.push_back(face.regions);
    mesh.face_patch.push_back(face.patch);
    mesh.face_tag.push_back(plc_.patches[face.patch].tag);
  }
  for (const auto& edge : stitched_.edges) {
    if (number[edge.corners[0]] == none || number[edge.corners[1]] == none) continue;
    mesh.edges.push_back({number[edge.corners[0]], number[edge.corners[1]]});
    mesh.edge_curve.push_back(edge.curve);
    mesh.edge_tag.push_back(plc_.curves[edge.curve].tag);
  }
  for (Index ball = 0; ball < collars_.balls().size(); ++ball)
    if (const Index v = ball_vertex(ball); v != none && number[v] != none)
      mesh.collar_balls.push_back({number[v], collars_.balls()[ball].radius, mesh.points[number[v]]});
  for (const FaceId face : marked_faces()) extract_face(face, number, mesh);
  // The middle of a triangle may lie in the plane of its patch, but beside the patch.
  std::vector<bool> on_surface(mesh.points.size(), false);
  for (const auto& face : mesh.faces)
    for (const Index v : face) on_surface[v] = true;
  for (Index v = 0; v < mesh.features.size(); ++v)
    if (mesh.features[v].dimension == 2 && !on_surface[v]) mesh.features[v] = {3, none};
  for (const Subsegment& s : subsegments_) {
    if (!s.alive || number[s.ends[0]] == none || number[s.ends[1]] == none) continue;
    mesh.edges.push_back({number[s.ends[0]], number[s.ends[1]]});
    mesh.edge_curve.push_back(s.curve);
    mesh.edge_tag.push_back(plc_.curves[s.curve].tag);
  }
  mesh.names = plc_.names;
  return mesh;
}

// Oriented so that the normal points from the first region to the second: as the patch is, except
// that a boundary's solid comes first.
void Refinement::extract_face(FaceId face, const std::vector<Index>& number, TetMesh& mesh) const {
  if (labels_[cell_of(face)].in_collar || labels_[cell_of(mesh_.opposite(face))].in_collar) return;
  const RestrictedTriangle& t = restricted(face);
  const Plc::Patch& patch = plc_.patches[patch_of(t)];
  // face_vertices is counterclockwise from outside its cell: the normal leaves that cell.
  auto v = mesh_.face_vertices(face);
  std::array<Index, 2> regions{labels_[cell_of(face)].region, labels_[cell_of(mesh_.opposite(face))].region};
  if (regions[0] == 0 && regions[1] == 0) return;
  bool reversed = regions[0] == 0;
  if (regions[0] == regions[1]) {
    const auto corners = hierarchy_.corners(t.triangle);
    const Vector n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vector m = cross(mesh_.point(v[1]) - mesh_.point(v[0]), mesh_.point(v[2]) - mesh_.point(v[0]));
    reversed = dot(n, m) < 0;
  } else if (regions[0] != 0 && regions[1] != 0) {
    reversed = regions[0] != patch.regions[0];
  }
  if (reversed) {
    std::swap(v[1], v[2]);
    std::swap(regions[0], regions[1]);
  }
  mesh.faces.push_back({number[v[0]], number[v[1]], number[v[2]]});
  mesh.face_regions.push_back(regions);
  mesh.face_patch.push_back(patch_of(t));
  mesh.face_tag.push_back(patch.tag);
}

}  // namespace collarmesh
