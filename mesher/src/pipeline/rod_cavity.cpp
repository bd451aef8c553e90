#include "pipeline/rod_cavity.h"

#include <algorithm>
#include <cmath>

#include "common/cell_shapes.h"
#include "common/sorted.h"

namespace collarmesh::pipeline {

namespace {

// Pieces of tets whose longest edge is shorter than this, relative to the sheath's reach, are not halved
// again.
constexpr double between_places = 0.4;

/// Returns the corners of a tet's face opposite a corner, with the normal away from the tet.
std::array<Index, 3> outward_face(const std::array<Index, 4>& tet, unsigned opposite) {
  constexpr std::array<std::array<unsigned, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const auto& [a, b, c] = faces[opposite];
  return {tet[a], tet[b], tet[c]};
}

}  // namespace

RodCavity::RodCavity(MeshAroundRods& around, Index rod, double room)
    : around_(around), rod_(around.rods[rod]), number_(rod) {
  const TetMesh& mesh = around.mesh;
  for (const Index t : around.near[rod]) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (!comes_within(room * rod_.reach, {mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]}))
      continue;
    if (around.taken[t] || around.without.region_of[mesh.tet_region[t]] != rod_.around) throw NoRoom();
    require_inner(mesh.tets[t]);
    tets_.push_back(t);
  }
  find_walls();
}

/// Returns whether some place in a tet is within this distance of the axis. Halves the tet until its pieces
/// are small, and tests their centres.
bool RodCavity::comes_within(double bound, const std::array<Point, 4>& p) const {
  const Point middle = (p[0] + p[1] + p[2] + p[3]) / 4;
  double radius = 0, longest = 0;
  std::array<unsigned, 2> edge{};
  for (const Point& corner : p) radius = std::max(radius, distance(middle, corner));
  for (const auto& ends : cell_shapes::corner_pairs)
    if (const double length = distance(p[ends[0]], p[ends[1]]); length > longest) {
      longest = length;
      edge = {ends[0], ends[1]};
    }
  const double there = around_.axes.distance(number_, middle);
  if (there <= bound || there > bound + radius || longest < between_places * rod_.reach)
    return there <= bound;
  return std::ranges::any_of(edge, [&](unsigned end) {
    std::array<Point, 4> half = p;
    half[end] = 0.5 * (p[edge[0]] + p[edge[1]]);
    return comes_within(bound, half);
  });
}

void RodCavity::find_walls() {
  const TetMesh& mesh = around_.mesh;
  struct Face {
    Wall wall;
    unsigned times = 0;
  };
  std::map<std::array<Index, 3>, Face> faces;
  for (const Index t : tets_)
    for (unsigned k = 0; k < 4; ++k) {
      const std::array<Index, 3> corners = outward_face(mesh.tets[t], k);
      ++faces.try_emplace(sorted(corners), Face{{corners, rod_.around}}).first->second.times;
    }
  for (const auto& [key, face] : faces) {
    const Index on_patch = around_.faces.find(key);
    if (on_patch == none) {
      if (face.times == 1) walls_.push_back(face.wall);
      continue;
    }
    const Index patch = around_.without.patch_of[mesh.face_patch[on_patch]];
    const auto is_host = [&](const SheathedRod::End& end) { return end.host == patch; };
    if (face.times != 1 || std::ranges::none_of(rod_.ends, is_host)) throw NoRoom();
    faces_.push_back(on_patch);
    const auto& [a, b, c] = face.wall.corners;
    add_outline(patch, a, b);
    add_outline(patch, b, c);
    add_outline(patch, c, a);
  }
  for (const SheathedRod::End& end : rod_.ends)
    if (!outlines_.contains(end.host)) throw NoRoom();
}

/// Throws NoRoom if a corner of the tet lies on a curve or at a vertex of the whole complex.
void RodCavity::require_inner(const std::array<Index, 4>& tet) const {
  for (const Index v : tet) {
    const auto& [dimension, feature] = around_.mesh.features[v];
    if (dimension == 1 || (dimension == 0 && around_.without.vertex_of[feature] != none)) throw NoRoom();
  }
}

/// Adds an edge to the outline on a patch. If the outline has the same edge in the opposite direction,
/// removes that edge instead.
void RodCavity::add_outline(Index patch, Index a, Index b) {
  Edges& edges = outlines_[patch];
  if (edges.erase({b, a}) == 0) edges.insert({a, b});
}

}  // namespace collarmesh::pipeline
