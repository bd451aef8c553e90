#include "shells/surface_mesher.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "common/sort_uniquely.h"
#include "shells/chord_limits.h"
#include "shells/curve_division.h"
#include "shells/sharp_corners.h"
#include "shells/vertex_removal.h"

namespace collarmesh::shells {

namespace {

// Edges longer than the first of these lengths, relative to the target, are divided; edges shorter than the
// second are collapsed.
constexpr double long_edge = 1.35, short_edge = 0.74;

}  // namespace

SurfaceMesher::SurfaceMesher(const Plc& plc, const MeshOptions& options, SurfaceTolerance tolerance,
                             double most_excess, const Execution& execution)
    : plc_(plc),
      execution_(execution),
      tolerance_(std::move(tolerance)),
      paths_(plc, plc.points),
      surfaces_(plc, tolerance_),
      sizes_(plc, paths_, options),
      editor_(complex_, plc, paths_, surfaces_, sizes_, tolerance_, most_excess),
      repair_(complex_, editor_, execution_) {}

void SurfaceMesher::take_complex() {
  std::vector<Index> number(plc_.points.size(), none);
  for (const Plc::Triangle& t : plc_.triangles)
    for (const Index p : t.points) {
      if (number[p] != none) continue;
      number[p] = complex_.add_vertex(plc_.points[p], {2, t.patch}, INFINITY, INFINITY);
      point_of_.push_back(p);
    }
  std::vector<std::pair<Index, double>> place_on_curve(complex_.vertices.size(), {none, 0});
  const auto add_edges = [&](Index curve) {
    const Plc::Curve& c = plc_.curves[curve];
    const std::vector<double>& lengths = paths_.lengths(curve);
    for (std::size_t i = 0; i + 1 < lengths.size(); ++i) {
      const Index a = number[c.points[i]], b = number[c.points[(i + 1) % c.points.size()]];
      if (a == none || b == none || complex_.triangles_at(a, b).empty()) continue;
      complex_.add_edge({a, b}, curve, {lengths[i], lengths[i + 1]});
      for (const auto& [v, at] : {std::pair{a, lengths[i]}, std::pair{b, lengths[i + 1]}}) {
        complex_.vertices[v].feature = {1, curve};
        place_on_curve[v] = {curve, at};
      }
    }
  };
  for (const Plc::Triangle& t : plc_.triangles)
    complex_.add_triangle({number[t.points[0]], number[t.points[1]], number[t.points[2]]}, t.patch);
  for (Index curve = 0; curve < plc_.curves.size(); ++curve) add_edges(curve);
  for (Index v = 0; v < plc_.vertices.size(); ++v)
    if (const Index at = number[plc_.vertices[v].point]; at != none) complex_.vertices[at].feature = {0, v};
  for (Index t = 0; t < plc_.triangles.size(); ++t)
    for (const Index p : plc_.triangles[t].points) {
      auto& vertex = complex_.vertices[number[p]];
      if (vertex.feature.dimension == 2)
        vertex.size = std::min(vertex.size, sizes_.on_patch(plc_.triangles[t].patch, t, vertex.point));
    }
  for (Index i = 0; i < complex_.vertices.size(); ++i) {
    auto& vertex = complex_.vertices[i];
    if (vertex.feature.dimension == 1)
      vertex.size = sizes_.on_curve(place_on_curve[i].first, place_on_curve[i].second);
    if (vertex.feature.dimension == 0) vertex.size = sizes_.at_vertex(vertex.feature.feature);
  }
  take_asked_sizes(place_on_curve);
  grade(complex_, sizes_.gradation());
}

void SurfaceMesher::take_asked_sizes(const std::vector<std::pair<Index, double>>& place_on_curve) {
  for (Index i = 0; i < complex_.vertices.size(); ++i) {
    auto& vertex = complex_.vertices[i];
    vertex.asked = vertex.size;
    if (vertex.feature.dimension == 1)
      vertex.asked = sizes_.asked_on_curve(place_on_curve[i].first, place_on_curve[i].second);
    if (vertex.feature.dimension == 0) vertex.asked = sizes_.asked_at_vertex(vertex.feature.feature);
  }
  grade(complex_, sizes_.gradation(), &SurfaceComplex::Vertex::asked);
}

/// Inserts vertices where `divide_curve` divides the curve, and marks them in `kept_`. `edges` are the
/// curve's edges in order.
void SurfaceMesher::divide_curve_at(Index curve, std::vector<Index>& edges, const std::array<double, 2>& tips,
                                    const ChordLimits& limits) {
  constexpr double same = 1e-6;
  const std::vector<double> places = divide_curve(
      plc_, paths_, [&](Index p) { return limits.at_point(p); }, sizes_, curve, tips);
  std::size_t next = 0;
  for (const Index first : edges) {
    Index edge = first;
    while (next < places.size()) {
      const auto& e = complex_.edges[edge];
      const double at = places[next], close = same * (e.at[1] - e.at[0]);
      if (at > e.at[1] + close) break;
      if (at >= e.at[1] - close || at <= e.at[0] + close) {
        kept_[e.ends[at >= e.at[1] - close ? 1 : 0]] = true;
        ++next;
        continue;
      }
      const Index v = editor_.divide_curve_edge(edge, at);
      ++next;
      if (v == none) continue;
      kept_.resize(complex_.vertices.size(), false);
      kept_[v] = true;
      edge = static_cast<Index>(complex_.edges.size() - 1);
    }
  }
}

void SurfaceMesher::divide_curves(const SharpCorners& corners) {
  kept_.assign(complex_.vertices.size(), false);
  const ChordLimits limits(complex_, plc_, point_of_, tolerance_);
  std::vector<std::vector<Index>> edges(plc_.curves.size());
  for (Index e = 0; e < complex_.edges.size(); ++e) edges[complex_.edges[e].curve].push_back(e);
  for (Index curve = 0; curve < plc_.curves.size(); ++curve)
    if (!edges[curve].empty()) divide_curve_at(curve, edges[curve], corners.tips(curve), limits);
}

/// Removes vertices inside curves that are not in `kept_`.
void SurfaceMesher::collapse_on_curves() {
  constexpr unsigned rounds = 3;
  const SurfaceEditor::CollapseRule rule{.longest = INFINITY, .least_shape = 0};
  for (unsigned round = 0; round < rounds; ++round) {
    bool blocked = false;
    for (Index v = 0; v < kept_.size(); ++v) {
      if (kept_[v] || complex_.vertices[v].triangles.empty() || complex_.vertices[v].feature.dimension != 1)
        continue;
      const auto around = editor_.edges_around(v);
      if (!around) continue;
      Index before = complex_.edges[(*around)[0]].ends[0], behind = complex_.edges[(*around)[1]].ends[1];
      if (editor_.length(v, behind) < editor_.length(v, before)) std::swap(before, behind);
      if (!editor_.collapse(v, before, rule) && !editor_.collapse(v, behind, rule)) blocked = true;
    }
    flip_all();
    if (!blocked) return;
  }
}

void SurfaceMesher::divide_long() {
  using Entry = std::tuple<double, Index, Index>;
  std::priority_queue<Entry> queue;
  const auto add = [&](Index a, Index b) {
    const double share = editor_.length(a, b) / editor_.size_of_edge(a, b);
    if (share > long_edge) queue.emplace(share, std::min(a, b), std::max(a, b));
  };
  const auto add_around = [&](Index v) {
    for (const Index n : complex_.neighbours(v)) add(v, n);
  };
  for (const auto& t : complex_.triangles)
    if (t.alive())
      for (unsigned i = 0; i < 3; ++i)
        if (t.corners[i] < t.corners[(i + 1) % 3]) add(t.corners[i], t.corners[(i + 1) % 3]);
  while (!queue.empty() && !execution_.cancelled()) {
    const auto [share, a, b] = queue.top();
    queue.pop();
    if (!complex_.have_triangle(a, b) || complex_.edge_at(a, b) != none) continue;
    const Index v = editor_.divide(a, b);
    if (v == none) continue;
    editor_.flip_around(v);
    add_around(v);
  }
}

void SurfaceMesher::collapse_short(double least_shape) {
  using Entry = std::tuple<double, Index, Index>;
  std::vector<Entry> edges;
  for (const auto& t : complex_.triangles) {
    if (!t.alive()) continue;
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = t.corners[i], b = t.corners[(i + 1) % 3];
      const double share = editor_.length(a, b) / editor_.size_of_edge(a, b);
      if (share < short_edge) edges.emplace_back(share, std::min(a, b), std::max(a, b));
    }
  }
  sort_uniquely(edges);
  const SurfaceEditor::CollapseRule rule{.longest = long_edge, .least_shape = least_shape};
  for (const auto& [share, a, b] : edges) {
    if (complex_.vertices[a].triangles.empty() || complex_.vertices[b].triangles.empty()) continue;
    if (!complex_.have_triangle(a, b)) continue;
    const auto inside = [&](Index v) { return complex_.vertices[v].feature.dimension == 2; };
    if (inside(a) && editor_.collapse(a, b, rule)) continue;
    if (inside(b)) editor_.collapse(b, a, rule);
  }
}

/// Flips edges where triangles have changed since the last call.
void SurfaceMesher::flip_all() {
  assert(complex_.consistent());
  constexpr unsigned rounds = 20;
  flipped_.resize(complex_.vertices.size(), 0);
  std::vector<bool> waiting(complex_.vertices.size(), false);
  std::vector<Index> changed;
  for (Index v = 0; v < flipped_.size(); ++v) {
    waiting[v] = flipped_[v] != complex_.vertices[v].changes + 1;
    if (waiting[v]) changed.push_back(v);
  }
  for (unsigned round = 0; round < rounds && !changed.empty(); ++round) {
    std::vector<Index> next;
    for (const Index v : changed) {
      waiting[v] = false;
      for (const Index n : complex_.neighbours(v)) {
        if (waiting[n]) continue;  // the edge is tested later, as an edge of n
        const auto two = complex_.two_triangles_at(v, n);
        if (!two) continue;
        const Index c = complex_.triangles[(*two)[0]].third(v, n),
                    d = complex_.triangles[(*two)[1]].third(v, n);
        if (editor_.flip(v, n)) next.insert(next.end(), {v, n, c, d});
      }
    }
    sort_uniquely(next);
    changed = std::move(next);
    for (const Index v : changed) waiting[v] = true;
  }
  for (Index v = 0; v < flipped_.size(); ++v) flipped_[v] = waiting[v] ? 0 : complex_.vertices[v].changes + 1;
}

void SurfaceMesher::smooth() {
  constexpr double least_way = 0.03;  // relative to the target edge length
  for (Index v = 0; v < complex_.vertices.size(); ++v) {
    if (complex_.vertices[v].triangles.empty() || complex_.vertices[v].feature.dimension != 2) continue;
    Point sum{};
    double weight = 0;
    for (const Index t : complex_.vertices[v].triangles) {
      const auto c = complex_.corners(t);
      double size = 0;
      for (const Index corner : complex_.triangles[t].corners) size += complex_.vertices[corner].size;
      const double share = norm(area_vector(c)) / (size * size);
      sum = sum + share / 3 * (c[0] + c[1] + c[2]);
      weight += share;
    }
    if (!(weight > 0) ||
        distance(sum / weight, complex_.vertices[v].point) < least_way * complex_.vertices[v].size)
      continue;
    const double least = std::min(editor_.least_shape_at(v), wanted_shape);
    if (editor_.move(v, sum / weight, least)) continue;
    editor_.move(v, 0.5 * (sum / weight + complex_.vertices[v].point), least);
  }
}

void SurfaceMesher::run() {
  constexpr unsigned rounds = 4;
  constexpr double any_shape = 2;
  take_complex();
  const SharpCorners corners(complex_, plc_, paths_, sizes_,
                             ChordLimits(complex_, plc_, point_of_, tolerance_));
  flip_all();
  divide_curves(corners);
  collapse_on_curves();
  collapse_short(any_shape);
  flip_all();
  corners.mark(complex_);
  constexpr std::size_t most_in_narrow_places = 100'000;
  constexpr double left_narrow = 0.12;
  if (NarrowPlaces(complex_, editor_, sizes_, execution_).run(most_in_narrow_places))
    repair_.set_narrowest(left_narrow);
  flip_all();
  for (unsigned round = 0; round < rounds && !execution_.cancelled(); ++round) {
    divide_long();
    collapse_short(round == 0 ? any_shape : least_angle);
    flip_all();
    smooth();
    flip_all();
    smooth();
  }
  // Limit on new vertices: where features of the input are very near each other, good shapes would need many
  // times more than the sizes ask for.
  std::size_t used = 0;
  for (const auto& vertex : complex_.vertices) used += vertex.triangles.empty() ? 0 : 1;
  const std::size_t limit = complex_.vertices.size() + 8'000 + used / 2;
  const auto rest = [&] { return limit - std::min(limit, complex_.vertices.size()); };
  repair_.approach(rest());
  repair_.run(rest());
  repair_.coarsen();
  flip_all();
  for (unsigned round = 0; round < 2; ++round) smooth();
  flip_all();
  repair_.improve(wanted_shape);
  constexpr unsigned last_rounds = 4;
  repair_.run(rest());
  for (unsigned round = 0; round < last_rounds && repair_.approach(rest()); ++round) repair_.run(rest());
  remove_needless_vertices();
  // Angles are near their bounds now, so that a new vertex in one triangle spoils those beside it: moves come
  // first.
  for (unsigned round = 0; round < last_rounds && repair_.approach(rest()); ++round) {
    repair_.improve(wanted_shape);
    repair_.run(rest());
  }
  repair_.improve(least_angle);
  assert(complex_.consistent());
}

/// Removes vertices and improves the triangles that stay; again if this removed more than one vertex in
/// `few`.
void SurfaceMesher::remove_needless_vertices() {
  constexpr unsigned rounds = 2;
  constexpr std::size_t few = 30;
  VertexRemoval removal(complex_, editor_, repair_, execution_);
  bool many = true;
  for (unsigned round = 0; many && round < rounds && !execution_.cancelled(); ++round) {
    many = removal.run() > complex_.vertices.size() / few;
    flip_all();
    repair_.improve(wanted_shape);
  }
}

/// Moves a vertex to its place on the exact geometry, unless a triangle's shape would fall below its bound
/// or, if it is below its bound already, decrease.
bool SurfaceMesher::project_vertex(Index vertex, const Point& target) {
  const Point before = complex_.vertices[vertex].point;
  std::vector<double> least;
  for (const Index t : complex_.vertices[vertex].triangles)
    least.push_back(std::min(editor_.shape(t), repair_.bound(t)));
  if (!editor_.put(vertex, target, *std::min_element(least.begin(), least.end()))) return false;
  for (std::size_t i = 0; i < least.size(); ++i) {
    if (editor_.shape(complex_.vertices[vertex].triangles[i]) >= least[i]) continue;
    complex_.move_vertex(vertex, before);
    return false;
  }
  return true;
}

ProjectReport SurfaceMesher::project(const ExactGeometry& exact, double most_excess) {
  assert(!complex_.vertices.empty());
  ProjectReport report;
  editor_.set_most_excess(most_excess);
  Index next = 0;  // numbers the vertices as `mesh` does
  for (Index v = 0; v < complex_.vertices.size() && !execution_.cancelled(); ++v) {
    const auto [dimension, feature] = complex_.vertices[v].feature;
    if (complex_.vertices[v].triangles.empty()) continue;
    const Index number = next++;
    if (dimension == 0) continue;
    const Point before = complex_.vertices[v].point;
    const std::optional<Point> target = exact(dimension, feature, before);
    if (!target) continue;
    ++report.vertices;
    const double way = distance(before, *target);
    if (way == 0) continue;
    if (way <= tolerance_.largest() && project_vertex(v, *target)) {
      report.largest_move = std::max(report.largest_move, way);
      continue;
    }
    report.largest_distance = std::max(report.largest_distance, way);
    report.exceptions.push_back({number, dimension, feature, before, way});
  }
  return report;
}

TetMesh SurfaceMesher::mesh() {
  TetMesh mesh;
  std::vector<Index> number(complex_.vertices.size(), none);
  for (Index v = 0; v < complex_.vertices.size(); ++v) {
    if (complex_.vertices[v].triangles.empty()) continue;
    number[v] = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(complex_.vertices[v].point);
    mesh.features.push_back(complex_.vertices[v].feature);
  }
  std::vector<Index> order;
  for (Index t = 0; t < complex_.triangles.size(); ++t)
    if (complex_.triangles[t].alive()) order.push_back(t);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return complex_.triangles[a].patch < complex_.triangles[b].patch;
  });
  for (const Index t : order) {
    const std::array<Index, 3>& corners = complex_.triangles[t].corners;
    const Index patch = complex_.triangles[t].patch;
    mesh.faces.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    mesh.face_patch.push_back(patch);
    mesh.face_tag.push_back(plc_.patches[patch].tag);
    mesh.face_regions.push_back({0, 0});
  }
  order.clear();
  for (Index e = 0; e < complex_.edges.size(); ++e)
    if (complex_.edges[e].alive()) order.push_back(e);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const auto &s = complex_.edges[a], &t = complex_.edges[b];
    return std::tie(s.curve, s.at[0], a) < std::tie(t.curve, t.at[0], b);
  });
  for (const Index e : order) {
    const auto& edge = complex_.edges[e];
    mesh.edges.push_back({number[edge.ends[0]], number[edge.ends[1]]});
    mesh.edge_curve.push_back(edge.curve);
    mesh.edge_tag.push_back(plc_.curves[edge.curve].tag);
    middles_.push_back(paths_.point(edge.curve, 0.5 * (edge.at[0] + edge.at[1])));
  }
  mesh.names = plc_.names;
  return mesh;
}

}  // namespace collarmesh::shells
