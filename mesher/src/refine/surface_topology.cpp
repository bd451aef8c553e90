#include "refine/surface_topology.h"

#include <algorithm>
#include <tuple>

#include "common/disjoint_sets.h"
#include "common/sort_by_vertex.h"
#include "common/sorted.h"

namespace collarmesh {

namespace {

struct SurfaceTriangle {
  std::array<Index, 3> corners;  // mesh vertices of a triangle
  Index patch;
  FaceId face;  // its face; no_face if it is stitched
};

struct Side {
  std::array<Index, 2> ends;  // mesh vertices, sorted
  Index patch;
  Index triangle;
  std::array<Index, 2> corners;  // corners of the triangle at these ends, 3 * triangle + i

  bool same_place(const Side& other) const { return ends == other.ends && patch == other.patch; }
  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.ends, a.patch, a.triangle) < std::tie(b.ends, b.patch, b.triangle);
  }
};

struct CurveEdge {
  std::array<Index, 2> ends;  // mesh vertices, sorted
  Index curve;
};

std::vector<Side> sorted_sides(const std::vector<SurfaceTriangle>& triangles, std::size_t vertices) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (Index t = 0; t < triangles.size(); ++t)
    for (unsigned i = 0; i < 3; ++i) {
      const unsigned j = (i + 1) % 3;
      const Index a = triangles[t].corners[i], b = triangles[t].corners[j];
      const Index at_a = 3 * t + i, at_b = 3 * t + j;
      sides.push_back(
          {sorted(a, b), triangles[t].patch, t, a < b ? std::array{at_a, at_b} : std::array{at_b, at_a}});
    }
  sort_by_vertex(sides, vertices, [](const Side& side) { return side.ends[0]; });
  return sides;
}

}  // namespace

// Counts, at the first segment of each curve, the triangles of each of the curve's patches.
void SurfaceTopology::count_curve_sides() {
  std::vector<CurveEdge> segments;  // by curve: its first segment
  segments.reserve(domain_.plc.curves.size());
  curve_sides_.reserve(domain_.plc.curves.size());
  for (Index c = 0; c < domain_.plc.curves.size(); ++c) {
    const auto& points = domain_.plc.curves[c].points;
    segments.push_back({sorted(points[0], points[1]), c});
    curve_sides_.emplace_back(domain_.plc.curves[c].patches.size(), 0);
  }
  std::ranges::sort(segments, {}, &CurveEdge::ends);
  for (const Plc::Triangle& t : domain_.plc.triangles)
    for (unsigned i = 0; i < 3; ++i) {
      const std::array<Index, 2> side = sorted(t.points[i], t.points[(i + 1) % 3]);
      const auto found = std::ranges::lower_bound(segments, side, {}, &CurveEdge::ends);
      if (found == segments.end() || found->ends != side) continue;
      const auto& patches = domain_.plc.curves[found->curve].patches;
      const auto patch = std::ranges::lower_bound(patches, t.patch);
      if (patch != patches.end() && *patch == t.patch)
        ++curve_sides_[found->curve][static_cast<std::size_t>(patch - patches.begin())];
    }
}

std::size_t SurfaceTopology::sides_at(Index curve, Index patch) const {
  const auto& patches = domain_.plc.curves[curve].patches;
  const auto found = std::ranges::lower_bound(patches, patch);
  return curve_sides_[curve][static_cast<std::size_t>(found - patches.begin())];
}

bool SurfaceTopology::check() {
  if (curve_sides_.empty()) count_curve_sides();
  std::vector<SurfaceTriangle> triangles;
  for (const FaceId face : surface_.marked_faces())
    if (!collar_cells_.inside(cell_of(face)) && !collar_cells_.inside(cell_of(mesh_.opposite(face))))
      triangles.push_back({mesh_.face_vertices(face), surface_.patch(face), face});
  for (const auto& face : stitching_.result().faces) triangles.push_back({face.corners, face.patch, no_face});
  if (triangles.empty()) return false;
  std::vector<CurveEdge> curve_edges;
  curves_.visit([&](Index, const Subsegment& s) {
    curve_edges.push_back({sorted(s.ends[0], s.ends[1]), s.curve});
  });
  for (const auto& edge : stitching_.result().edges)
    curve_edges.push_back({sorted(edge.corners[0], edge.corners[1]), edge.curve});
  std::ranges::sort(curve_edges, {}, &CurveEdge::ends);
  const std::vector<Side> sides = sorted_sides(triangles, mesh_.vertex_count());
  DisjointSets fans(3 * triangles.size());
  std::vector<Index> wrong_at(mesh_.vertex_count(), none);  // by vertex: a patch that is wrong there
  for (const Index v : stitching_.result().open)
    wrong_at[v] = mesh_.feature(v).dimension == 2 ? mesh_.feature(v).index : none;
  const auto expected = [&](const Side& side) -> std::size_t {
    const auto edge = std::ranges::lower_bound(curve_edges, side.ends, {}, &CurveEdge::ends);
    if (edge == curve_edges.end() || edge->ends != side.ends ||
        !domain_.plc.curve_on_patch(edge->curve, side.patch))
      return 2;
    return sides_at(edge->curve, side.patch);
  };
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].same_place(sides[i]); ++j)
      for (unsigned end = 0; end < 2; ++end) fans.unite(sides[i].corners[end], sides[j].corners[end]);
    if (j - i == expected(sides[i])) continue;
    for (const Index end : sides[i].ends) wrong_at[end] = sides[i].patch;
  }
  std::vector<std::array<Index, 3>> patch_fans;  // vertex, patch, fan
  for (Index corner = 0; corner < 3 * triangles.size(); ++corner) {
    const Index v = triangles[corner / 3].corners[corner % 3];
    if (mesh_.feature(v).dimension > 0)
      patch_fans.push_back({v, triangles[corner / 3].patch, fans.find(corner)});
  }
  sort_by_vertex(patch_fans, mesh_.vertex_count(), [](const auto& fan) { return fan[0]; });
  for (std::size_t i = 1; i < patch_fans.size(); ++i) {
    const auto& [v, patch, fan] = patch_fans[i];
    const auto& before = patch_fans[i - 1];
    if (v == before[0] && patch == before[1] && fan != before[2]) wrong_at[v] = patch;
  }
  bool found = false;
  for (const SurfaceTriangle& t : triangles) {
    if (t.face == no_face || surface_.notes(t.face).given_up) continue;
    const auto is_wrong = [&](Index v) { return wrong_at[v] == t.patch || !mesh_.on_patch(v, t.patch); };
    if (std::ranges::none_of(t.corners, is_wrong)) continue;
    triangles_.split(t.face);
    found = true;
  }
  return found && surface_check_.another_round();
}

}  // namespace collarmesh
