#include "remesh/curve_slides.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "common/round_curves.h"
#include "common/segments.h"
#include "common/sorted.h"
#include "location/feature_shapes.h"

namespace collarmesh::remeshing {

CurveSlides::CurveSlides(const Plc& plc, const TetMesh& mesh, SurfaceTolerance tolerance,
                         double edges_per_hole)
    : plc_(plc), mesh_(mesh), tolerance_(std::move(tolerance)), paths_(plc, plc.points) {
  spare_edges_.reserve(plc.curves.size());
  for (const Plc::Curve& curve : plc.curves)
    spare_edges_.push_back(-static_cast<std::ptrdiff_t>(least_edges(plc, curve, edges_per_hole)));
  for (const Index curve : mesh.edge_curve)
    if (curve != none) ++spare_edges_[curve];
}

bool CurveSlides::movable(Index vertex) const {
  prepare();
  return vertex < places_.size() && places_[vertex].neighbours[0] != none &&
         places_[vertex].neighbours[1] != none;
}

void CurveSlides::find_all_places() const {
  places_.resize(mesh_.points.size());
  std::vector<Index> point_of(plc_.vertices.size(), none);
  std::vector<std::vector<Index>> vertices(plc_.curves.size());
  for (Index v = 0; v < mesh_.features.size(); ++v) {
    const auto& feature = mesh_.features[v];
    if (feature.feature == none) continue;
    if (feature.dimension == 0) point_of[feature.feature] = v;
    if (feature.dimension == 1) vertices[feature.feature].push_back(v);
  }
  for (Index c = 0; c < plc_.curves.size(); ++c) {
    std::array<Index, 2> ends{none, none};
    for (unsigned i = 0; i < 2; ++i)
      if (plc_.curves[c].ends[i] != none) ends[i] = point_of[plc_.curves[c].ends[i]];
    if (!vertices[c].empty()) find_places(c, vertices[c], ends);
  }
  // Forget neighbours on the curve that no mesh edge joins to the vertex.
  std::vector<std::array<Index, 2>> edges;
  for (const auto& e : mesh_.edges) edges.push_back(sorted(e));
  std::ranges::sort(edges);
  for (Index v = 0; v < places_.size(); ++v)
    for (Index& n : places_[v].neighbours)
      if (n != none && !std::ranges::binary_search(edges, sorted(v, n))) n = none;
}

void CurveSlides::find_places(Index curve, std::vector<Index>& vertices,
                              const std::array<Index, 2>& ends) const {
  const auto& lengths = paths_.lengths(curve);
  const TriangleHierarchy hierarchy(plc_.points, flat_triangles_of(plc_.curves[curve]));
  for (const Index v : vertices) {
    const Index at = nearest_triangle(hierarchy, mesh_.points[v]);
    const double step = distance(mesh_.points[v], hierarchy.corners(at)[0]);
    places_[v].parameter = std::min(lengths[at] + step, lengths[at + 1]);
  }
  std::ranges::sort(vertices, {}, [&](Index v) { return places_[v].parameter; });
  const bool closed = plc_.curves[curve].closed;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    auto& neighbours = places_[vertices[i]].neighbours;
    neighbours[0] = i > 0 ? vertices[i - 1] : closed ? vertices.back() : ends[0];
    neighbours[1] = i + 1 < vertices.size() ? vertices[i + 1] : closed ? vertices.front() : ends[1];
  }
}

// Returns the arc length, positive, from a vertex to its neighbour behind (side 0) or ahead (side 1).
double CurveSlides::way_to_neighbour(Index vertex, unsigned side) const {
  const Index neighbour = places_[vertex].neighbours[side];
  const Index curve = mesh_.features[vertex].feature;
  const double length = paths_.length(curve);
  const bool end = mesh_.features[neighbour].dimension == 0;
  const double other = end ? (side == 0 ? 0 : length) : places_[neighbour].parameter;
  const double way = side == 0 ? places_[vertex].parameter - other : other - places_[vertex].parameter;
  return plc_.curves[curve].closed ? way - length * std::floor(way / length) : way;
}

Point CurveSlides::ahead(Index vertex, double way) const {
  return paths_.point(mesh_.features[vertex].feature, places_[vertex].parameter + way);
}

bool CurveSlides::fits(Index vertex, double way) const {
  const Place& place = places_[vertex];
  const Index curve = mesh_.features[vertex].feature;
  const double behind = way_to_neighbour(vertex, 0), before = way_to_neighbour(vertex, 1);
  if (way <= -behind || way >= before) return false;
  const Point at = ahead(vertex, way);
  return edge_fits(curve, place.parameter - behind, behind + way, mesh_.points[place.neighbours[0]], at) &&
         edge_fits(curve, place.parameter + way, before - way, at, mesh_.points[place.neighbours[1]]);
}

bool CurveSlides::may_skip(Index vertex) const {
  const auto [before, after] = places_[vertex].neighbours;
  if (before == after || spare_edges_[mesh_.features[vertex].feature] <= 0) return false;
  const double behind = way_to_neighbour(vertex, 0), ahead = way_to_neighbour(vertex, 1);
  return edge_fits(mesh_.features[vertex].feature, places_[vertex].parameter - behind, behind + ahead,
                   mesh_.points[before], mesh_.points[after]);
}

void CurveSlides::skipped(Index vertex) {
  const auto [before, after] = places_[vertex].neighbours;
  old_spare_edges_.note(mesh_.features[vertex].feature);
  --spare_edges_[mesh_.features[vertex].feature];
  const auto join = [&](Index end, unsigned side, Index neighbour) {
    if (mesh_.features[end].dimension != 1) return;
    old_places_.note(end);
    places_[end].neighbours[side] = neighbour;
  };
  join(before, 1, after);
  join(after, 0, before);
}

// Returns whether vertex `next` comes after `vertex` on the curve. Precondition: an edge on the curve joins
// them.
bool CurveSlides::follows(Index curve, Index vertex, Index next) const {
  assert(vertex != next && mesh_.features[vertex].dimension <= 1 && mesh_.features[next].dimension <= 1);
  if (mesh_.features[vertex].dimension == 1) return places_[vertex].neighbours[1] == next;
  if (mesh_.features[next].dimension == 1) return places_[next].neighbours[0] == vertex;
  return mesh_.features[vertex].feature == plc_.curves[curve].ends[0];
}

std::optional<CurveSlides::Part> CurveSlides::part_of_edge(Index curve, Index a, Index b) const {
  prepare();
  if (!follows(curve, a, b)) std::swap(a, b);
  if (!follows(curve, a, b)) return std::nullopt;
  const double length = paths_.length(curve);
  const double from = mesh_.features[a].dimension == 1 ? places_[a].parameter : 0;
  double to = mesh_.features[b].dimension == 1 ? places_[b].parameter : length;
  if (plc_.curves[curve].closed) to -= length * std::floor((to - from) / length);
  if (!(to > from)) return std::nullopt;
  return Part{{a, b}, from, to};
}

std::optional<CurveSlides::Middle> CurveSlides::middle(Index curve, Index a, Index b) const {
  const auto part = part_of_edge(curve, a, b);
  if (!part) return std::nullopt;
  return Middle{part->ends, 0.5 * (part->from + part->to)};
}

bool CurveSlides::edge_is_near(Index curve, Index a, Index b) const {
  const auto part = part_of_edge(curve, a, b);
  return part && edge_fits(curve, part->from, part->to - part->from, mesh_.points[part->ends[0]],
                           mesh_.points[part->ends[1]]);
}

void CurveSlides::divided(Index vertex, const Middle& middle) {
  const Index curve = mesh_.features[vertex].feature;
  old_spare_edges_.note(curve);
  ++spare_edges_[curve];
  places_.resize(std::max<std::size_t>(places_.size(), vertex + 1));
  places_[vertex] = {middle.parameter, middle.ends};
  for (unsigned side = 0; side < 2; ++side) {
    const Index end = middle.ends[side];
    if (mesh_.features[end].dimension != 1) continue;
    old_places_.note(end);
    places_[end].neighbours[1 - side] = vertex;
  }
}

// Returns whether the edge ab and a part of a curve are within the tolerance of each other. The part starts
// at `from` and has the arc length `way`.
bool CurveSlides::edge_fits(Index curve, double from, double way, const Point& a, const Point& b) const {
  const auto& lengths = paths_.lengths(curve);
  const double length = lengths.back();
  const std::size_t count = lengths.size() - 1;
  std::vector<Point> part{a};
  std::size_t segment = paths_.segment(curve, from);
  const double start = plc_.curves[curve].closed ? from - length * std::floor(from / length) : from;
  const auto tolerance_at = [&](std::size_t i) {
    const auto [p, q] = paths_.segment_ends(curve, i);
    return tolerance_.at_segment(p, q);
  };
  double tolerance = tolerance_at(segment);
  for (double travelled = lengths[segment + 1] - start; travelled < way;) {
    part.push_back(plc_.points[paths_.segment_ends(curve, segment)[1]]);
    segment = (segment + 1) % count;
    tolerance = std::min(tolerance, tolerance_at(segment));
    travelled += lengths[segment + 1] - lengths[segment];
  }
  part.push_back(b);
  const double squared_bound = tolerance * tolerance;
  for (const Point& p : part)
    if (squared_distance_to_segment(p, a, b) > squared_bound) return false;
  for (const double t : {0.25, 0.5, 0.75}) {
    const Point p = a + t * (b - a);
    std::size_t i = 1;
    while (i < part.size() && squared_distance_to_segment(p, part[i - 1], part[i]) > squared_bound) ++i;
    if (i == part.size()) return false;
  }
  return true;
}

}  // namespace collarmesh::remeshing
