// Removes vertices, and fills the holes with the best triangles.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "common/distances.h"
#include "shells/best_triangles.h"
#include "shells/surface_editor.h"

namespace collarmesh::shells {

namespace {

// Least cosine of the angle between a new triangle and its patch.
constexpr double least_agreement_left = 0.6;
// Vertices with more triangles stay.
constexpr std::size_t most_triangles_removed = 12;

/// Returns the corner of a triangle after v.
Index after(const SurfaceComplex::Triangle& t, Index v) {
  const auto& c = t.corners;
  return c[0] == v ? c[1] : c[1] == v ? c[2] : c[0];
}

}  // namespace

/// Walks through the triangles of a patch around a vertex, from the given one up to a curve or around the
/// vertex. Returns nothing if they are not oriented alike.
std::optional<SurfaceEditor::Hole> SurfaceEditor::hole_from(Index vertex, Index triangle,
                                                            std::vector<Index>& seen) const {
  Hole hole{complex_.triangles[triangle].patch, {after(complex_.triangles[triangle], vertex)}};
  for (Index at = triangle; seen.size() < complex_.vertices[vertex].triangles.size();) {
    seen.push_back(at);
    const Index last = complex_.triangles[at].third(vertex, hole.border.back());
    if (last == hole.border.front()) return hole;
    hole.border.push_back(last);
    if (complex_.edge_at(vertex, last) != none) return hole;
    at = complex_.across(at, vertex, last);
    if (at == none || after(complex_.triangles[at], vertex) != last) return std::nullopt;
  }
  return std::nullopt;
}

/// Returns the holes that removing a vertex leaves in the patches; nothing unless the vertex is surrounded by
/// one patch or, on a curve, by one or more patches between its edges there.
std::optional<std::vector<SurfaceEditor::Hole>> SurfaceEditor::holes_around(Index vertex) const {
  const auto& v = complex_.vertices[vertex];
  std::vector<Hole> holes;
  std::vector<Index> seen;
  const auto add_from = [&](Index triangle) {
    std::optional<Hole> hole = hole_from(vertex, triangle, seen);
    if (hole) holes.push_back(std::move(*hole));
    return hole.has_value();
  };
  if (v.feature.dimension == 2) {
    if (!add_from(v.triangles.front()) || complex_.edge_at(vertex, holes[0].border.back()) != none)
      return std::nullopt;
  } else {
    for (const Index t : v.triangles)
      if (complex_.edge_at(vertex, after(complex_.triangles[t], vertex)) != none && !add_from(t))
        return std::nullopt;
  }
  if (seen.size() != v.triangles.size()) return std::nullopt;
  return holes;
}

bool SurfaceEditor::may_join(Index a, Index b, const Removal& rule) const {
  return length(a, b) <= rule.longest * asked_of_edge(a, b) && !complex_.have_triangle(a, b) &&
         complex_.edge_at(a, b) == none;
}

/// Appends the best triangles for a hole to `created`. Returns false if the rule permits none.
bool SurfaceEditor::fill(const Hole& hole, const Removal& rule, std::vector<Created>& created) const {
  const std::vector<Index>& border = hole.border;
  std::vector<Point> polygon;
  polygon.reserve(border.size());
  for (const Index v : border) polygon.push_back(complex_.vertices[v].point);
  const auto triangles = best_triangles(polygon, rule.least_shape, [&](unsigned i, unsigned j) {
    return may_join(border[i], border[j], rule);
  });
  if (!triangles) return false;
  for (const auto& [i, j, k] : *triangles) created.push_back({{border[i], border[j], border[k]}, hole.patch});
  return true;
}

/// Returns whether triangles fit the patch as well as required, and are near the vertex that they replace.
bool SurfaceEditor::filling_fits(Index vertex, const Hole& hole, std::span<const Created> created) const {
  const Point& p = complex_.vertices[vertex].point;
  double squared = INFINITY;
  for (const Created& t : created) {
    const Corners corners = complex_.corners(t.corners);
    const PatchSurfaces::Fit fit = surfaces_.fit(corners, hole.patch, most_excess_);
    if (fit.agreement < least_agreement_left || fit.excess > most_excess_) return false;
    squared = std::min(squared, squared_distance_to_triangle(p, corners[0], corners[1], corners[2]));
    if (surfaces_.planar(hole.patch)) continue;
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = t.corners[i], b = t.corners[(i + 1) % 3];
      if (complex_.have_triangle(a, b) || complex_.edge_at(a, b) != none) continue;
      if (surfaces_.excess_between(hole.patch, complex_.vertices[a].point, complex_.vertices[b].point,
                                   most_excess_) > most_excess_)
        return false;
    }
  }
  return created.empty() || surfaces_.planar(hole.patch) ||
         std::sqrt(squared) <= most_excess_ * surfaces_.nearest(hole.patch, p).tolerance;
}

/// Returns whether a chord may replace the two edges at a vertex inside a curve.
bool SurfaceEditor::chord_permits(Index vertex, std::span<const Hole> holes, const Removal& rule) const {
  const auto around = edges_around(vertex);
  if (!around || holes.empty()) return false;
  const Index a = complex_.edges[(*around)[0]].ends[0], b = complex_.edges[(*around)[1]].ends[1];
  if (a == b || complex_.edge_at(a, b) != none || length(a, b) > rule.longest * asked_of_edge(a, b) ||
      sag_across(*around) > most_excess_)
    return false;
  // If a hole is a single triangle, its third side becomes the chord. At this side there may be only such
  // triangles and, beyond each of them, one other triangle.
  std::size_t flat = 0;
  for (const Hole& hole : holes) {
    const bool between = std::minmax(hole.border.front(), hole.border.back()) == std::minmax(a, b);
    if (!between) return false;
    if (hole.border.size() == 2) ++flat;
  }
  return complex_.triangles_at(a, b).size() == 2 * flat;
}

std::optional<SurfaceEditor::Filling> SurfaceEditor::filling_without(Index vertex,
                                                                     const Removal& rule) const {
  const auto& v = complex_.vertices[vertex];
  if (v.feature.dimension == 0 || v.triangles.size() > most_triangles_removed || ends_tip(vertex))
    return std::nullopt;
  const auto holes = holes_around(vertex);
  if (!holes) return std::nullopt;
  if (v.feature.dimension == 1 ? !chord_permits(vertex, *holes, rule) : (*holes)[0].border.size() < 3)
    return std::nullopt;
  Filling filling;
  std::vector<Created>& created = filling.triangles;
  std::vector<std::size_t> first{0};
  for (const Hole& hole : *holes) {
    if (!fill(hole, rule, created)) return std::nullopt;
    first.push_back(created.size());
  }
  const std::span<const Created> all(created);
  for (std::size_t i = 0; i < holes->size(); ++i)
    if (!filling_fits(vertex, (*holes)[i], all.subspan(first[i], first[i + 1] - first[i])))
      return std::nullopt;
  const auto exists = [&](const Created& t) {
    return std::ranges::any_of(complex_.triangles_at(t.corners[0], t.corners[1]),
                               [&](Index other) { return complex_.triangles[other].has(t.corners[2]); });
  };
  if (std::ranges::any_of(created, exists)) return std::nullopt;
  for (const Created& t : created)
    filling.least_shape = std::min(filling.least_shape, shape_of(complex_.corners(t.corners)));
  return filling;
}

SurfaceEditor::Surroundings SurfaceEditor::surroundings(Index vertex) const {
  const auto& v = complex_.vertices[vertex];
  Surroundings before{.vertex = vertex,
                      .triangles = {},
                      .edges = {},
                      .first_triangle = static_cast<Index>(complex_.triangles.size()),
                      .first_edge = static_cast<Index>(complex_.edges.size()),
                      .neighbours = {},
                      .changes = {},
                      .places = {}};
  for (const Index t : v.triangles) before.triangles.push_back(complex_.triangles[t]);
  for (const Index e : v.edges) before.edges.push_back(complex_.edges[e]);
  for (const Index n : complex_.neighbours(vertex)) {
    const auto& other = complex_.vertices[n];
    before.neighbours.push_back({n, other.point, least_shape_at(n)});
    for (const Index t : other.triangles)
      for (const Index c : complex_.triangles[t].corners)
        before.changes.emplace_back(c, complex_.vertices[c].changes);
    for (const Index e : other.edges)
      if (complex_.edges[e].ends[0] != vertex && complex_.edges[e].ends[1] != vertex)
        before.places.emplace_back(e, complex_.edges[e].at);
  }
  return before;
}

void SurfaceEditor::restore(const Surroundings& before) {
  assert(complex_.vertices[before.vertex].triangles.empty());
  for (Index t = before.first_triangle; t < complex_.triangles.size(); ++t) complex_.remove_triangle(t);
  for (Index e = before.first_edge; e < complex_.edges.size(); ++e) complex_.remove_edge(e);
  for (const auto& n : before.neighbours) complex_.move_vertex(n.vertex, n.point);
  for (const auto& [edge, at] : before.places) complex_.edges[edge].at = at;
  for (const auto& edge : before.edges) {
    complex_.add_edge(edge.ends, edge.curve, edge.at);
    complex_.edges.back().tip = edge.tip;
  }
  for (const auto& t : before.triangles) complex_.add_triangle(t.corners, t.patch);
  for (const auto& [v, changes] : before.changes) complex_.vertices[v].changes = changes;
  assert(complex_.consistent(before.vertex));
  assert(
      std::ranges::all_of(before.neighbours, [&](const auto& n) { return complex_.consistent(n.vertex); }));
}

}  // namespace collarmesh::shells
