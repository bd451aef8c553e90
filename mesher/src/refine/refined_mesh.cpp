#include "refine/refined_mesh.h"

#include <algorithm>

namespace collarmesh {

RefinedMesh::RefinedMesh(const Plc& plc, const Box& box)
    : plc_(plc), triangulation_(box), walk_(triangulation_) {
  features_.resize(vertex_count(), Feature{3, none});
}

bool RefinedMesh::on_one_patch(std::span<const Index> vertices) const {
  for (const Index v : vertices)
    if (features_[v].dimension == 3) return false;
  const auto contains_all = [&](Index patch) {
    return std::all_of(vertices.begin(), vertices.end(), [&](Index v) { return on_patch(v, patch); });
  };
  const Feature& f = features_[vertices[0]];
  if (f.dimension == 2) return contains_all(f.index);
  const auto& patches = f.dimension == 0 ? plc_.vertices[f.index].patches : plc_.curves[f.index].patches;
  return std::any_of(patches.begin(), patches.end(), contains_all);
}

// Finds the nearest vertex. At first the only vertices are the corners of the box, which are cospherical and
// not all neighbours.
Index RefinedMesh::nearest_vertex(const Point& p, Index near) const {
  if (vertex_count() > 8) return walk_.nearest(p, near == none ? last_vertex() : near);
  Index nearest = 0;
  for (Index corner = 1; corner < 8; ++corner)
    if (squared_distance(p, point(corner)) < squared_distance(p, point(nearest))) nearest = corner;
  return nearest;
}

}  // namespace collarmesh
