#include "shells/shape_repair.h"

#include <algorithm>
#include <utility>

namespace collarmesh::shells {

namespace {

// Shapes (see shape_of) must exceed their bounds by this margin, degrees, so that angles stay within their
// bounds when vertices move onto exact geometry.
constexpr double margin = 1.5;
// Edges shorter than twice this share of the target edge length are not divided.
constexpr double shortest = 0.015;
// Vertices with more triangles, which a tessellation may have, are neither moved nor removed.
constexpr std::size_t most_triangles = 24;
// The smallest gain of shape, degrees, for which a vertex is moved.
constexpr double least_gain = 0.1;

}  // namespace

ShapeRepair::ShapeRepair(SurfaceComplex& complex, SurfaceEditor& editor, const Execution& execution)
    : complex_(complex), editor_(editor), execution_(execution) {}

double ShapeRepair::bound(Index triangle) const {
  constexpr double degrees = 57.29577951308232;
  const auto& c = complex_.triangles[triangle].corners;
  double bound = least_angle;
  for (unsigned i = 0; i < 3; ++i) {
    const Index v = c[i], a = c[(i + 1) % 3], b = c[(i + 2) % 3];
    if (complex_.vertices[v].feature.dimension != 0 || complex_.edge_at(v, a) == none ||
        complex_.edge_at(v, b) == none)
      continue;
    const Vector u = complex_.vertices[a].point - complex_.vertices[v].point,
                 w = complex_.vertices[b].point - complex_.vertices[v].point;
    bound = std::min(bound, 0.5 * degrees * std::atan2(norm(cross(u, w)), dot(u, w)));
  }
  return bound;
}

bool ShapeRepair::poor(Index triangle, double wanted) const {
  if (!complex_.triangles[triangle].alive()) return false;
  const double shape = editor_.shape(triangle);
  if (shape >= wanted) return false;
  return shape < wanted * bound(triangle) / least_angle;
}

/// Returns whether an attempt to improve the triangle to at least `wanted` has failed and nothing around it
/// has changed since.
bool ShapeRepair::tried(Index triangle, double wanted) {
  if (triangle >= tried_.size()) return false;
  std::size_t changes = 0;
  for (const Index v : complex_.triangles[triangle].corners) changes += complex_.vertices[v].changes;
  return tried_[triangle].changes == changes && tried_[triangle].wanted >= wanted;
}

void ShapeRepair::note_tried(Index triangle, double wanted) {
  if (triangle >= tried_.size()) tried_.resize(complex_.triangles.size());
  std::size_t changes = 0;
  for (const Index v : complex_.triangles[triangle].corners) changes += complex_.vertices[v].changes;
  tried_[triangle] = {changes, wanted};
}

std::vector<Index> ShapeRepair::poor_triangles(double wanted, std::span<const Index> known,
                                               Index first) const {
  std::vector<std::pair<double, Index>> poor_ones;
  const auto look_at = [&](Index t) {
    if (poor(t, wanted)) poor_ones.emplace_back(editor_.shape(t), t);
  };
  for (const Index t : known) look_at(t);
  for (Index t = first; t < complex_.triangles.size(); ++t) look_at(t);
  std::sort(poor_ones.begin(), poor_ones.end());
  std::vector<Index> triangles;
  triangles.reserve(poor_ones.size());
  for (const auto& [shape, t] : poor_ones) triangles.push_back(t);
  return triangles;
}

bool ShapeRepair::move_best(Index vertex) {
  if (vertex >= not_movable_.size()) not_movable_.resize(complex_.vertices.size(), 0);
  if (not_movable_[vertex] == complex_.vertices[vertex].changes + 1) return false;
  if (move_within(vertex)) return true;
  not_movable_[vertex] = complex_.vertices[vertex].changes + 1;
  return false;
}

bool ShapeRepair::move_within(Index vertex) {
  const auto& v = complex_.vertices[vertex];
  if (v.feature.dimension == 0 || v.triangles.size() > most_triangles) return false;
  const VertexFan fan(complex_, vertex);
  return v.feature.dimension == 1 ? move_on_curve(vertex, fan) : move_on_patch(vertex, fan);
}

// Tries places on the curve, and moves the vertex to the best one.
bool ShapeRepair::move_on_curve(Index vertex, const VertexFan& fan) {
  const auto around = editor_.edges_around(vertex);
  if (!around || editor_.ends_tip(vertex)) return false;
  const auto& before = complex_.edges[(*around)[0]].at;
  const auto& behind = complex_.edges[(*around)[1]].at;
  const double start = before[1], last = behind[1] - (behind[0] - before[1]), first = before[0];
  const double now = editor_.least_shape_at(vertex);
  double at = start, best = now;
  for (const double share : {0.5, 0.25, 0.1, 0.03})
    for (const double end : {first, last}) {
      const double to = at + share * (end - at);
      const double shape = fan.least_shape(editor_.place_on_curve(vertex, to), best + least_gain);
      if (shape < best + least_gain) continue;
      best = shape;
      at = to;
    }
  if (at == start) return false;
  return editor_.slide(vertex, at, now + least_gain) ||
         editor_.slide(vertex, 0.5 * (start + at), now + least_gain);
}

bool ShapeRepair::move_on_patch(Index vertex, const VertexFan& fan) {
  if (!(norm(fan.normal()) > 0)) return false;
  const double now = editor_.least_shape_at(vertex);
  double best = now;
  Vector way{};
  const auto look_at = [&](const Vector& step) {
    const double shape = fan.least_turned_shape(fan.place(step), best + least_gain);
    if (shape < best + least_gain) return;
    best = shape;
    way = step;
  };
  const double diagonal = std::sqrt(0.5);
  const Vector u = fan.across(), v = cross(fan.normal(), u);
  look_at(fan.centre());
  for (const double share : {0.3, 0.1, 0.03})
    for (const auto& [x, y] : {std::pair{1.0, 0.0},
                               {diagonal, diagonal},
                               {0.0, 1.0},
                               {-diagonal, diagonal},
                               {-1.0, 0.0},
                               {-diagonal, -diagonal},
                               {0.0, -1.0},
                               {diagonal, -diagonal}})
      look_at(way + share * fan.reach() * (x * u + y * v));
  if (best <= now) return false;
  return editor_.move(vertex, fan.place(way), now + least_gain) ||
         editor_.move(vertex, fan.place(0.5 * way), now + least_gain);
}

bool ShapeRepair::improve_by_moves(Index triangle) {
  bool moved = false;
  for (const Index v : std::array(complex_.triangles[triangle].corners)) moved |= move_best(v);
  return moved;
}

/// Moves the corners of a triangle, at most three times for each triangle, because small gains would go on
/// for long.
bool ShapeRepair::move_corners(Index triangle) {
  constexpr unsigned char most = 3;
  if (triangle >= moves_.size()) moves_.resize(complex_.triangles.size(), 0);
  if (moves_[triangle] == most || !improve_by_moves(triangle)) return false;
  ++moves_[triangle];
  return true;
}

bool ShapeRepair::improve_connections(Index triangle, double wanted, bool may_collapse) {
  const std::array<Index, 3> c = complex_.triangles[triangle].corners;
  for (unsigned i = 0; i < 3; ++i)
    if (editor_.flip(c[i], c[(i + 1) % 3])) return true;
  if (!may_collapse) return false;
  const SurfaceEditor::CollapseRule rule{.longest = 1.5, .least_shape = wanted, .better = true};
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j)
      if (i != j && complex_.vertices[c[i]].triangles.size() <= most_triangles &&
          editor_.collapse(c[i], c[j], rule))
        return true;
  return false;
}

void ShapeRepair::improve(double wanted) {
  constexpr unsigned passes = 4;
  std::vector<Index> poor_ones;
  Index first = 0;
  for (unsigned pass = 0; pass < passes && !execution_.cancelled(); ++pass) {
    bool changed = false;
    poor_ones = poor_triangles(wanted, poor_ones, first);
    first = static_cast<Index>(complex_.triangles.size());
    for (const Index t : poor_ones) {
      if (!poor(t, wanted) || tried(t, wanted)) continue;
      if (improve_connections(t, wanted, true) || improve_by_moves(t))
        changed = true;
      else
        note_tried(t, wanted);
    }
    if (!changed) return;
  }
}

/// Divides a side of the triangle that lies on a curve, if a vertex at p would encroach upon it. Returns
/// whether a vertex at p would encroach upon such a side, even if the side cannot be divided.
bool ShapeRepair::divide_curve_beside(Index triangle, const Point& p) {
  constexpr double least_cosine = -0.45;  // cosine of 117 degrees
  const std::array<Index, 3> c = complex_.triangles[triangle].corners;
  for (unsigned i = 0; i < 3; ++i) {
    const Index edge = complex_.edge_at(c[i], c[(i + 1) % 3]);
    if (edge == none) continue;
    const auto [a, b] = complex_.edges[edge].ends;
    const Vector to_a = complex_.vertices[a].point - p, to_b = complex_.vertices[b].point - p;
    // Tips are not divided. A vertex at p encroaches upon a tip only if the angle at p exceeds 117 degrees.
    if (complex_.edges[edge].tip != none) {
      if (dot(to_a, to_b) < least_cosine * norm(to_a) * norm(to_b)) return true;
      continue;
    }
    if (dot(to_a, to_b) >= 0) continue;
    if (editor_.length(a, b) < 2 * shortest * editor_.size_of_edge(a, b)) return true;
    const Index v = editor_.divide_curve_edge(edge);
    if (v == none) return true;
    editor_.flip_around(v);
    return true;
  }
  return false;
}

/// Walks from the triangle to the one that contains p, and inserts a vertex there, unless a corner is nearer
/// to p than `nearest`. If an edge of a curve is in the way, divides this edge and inserts nothing at p.
/// Returns whether there is a new vertex.
bool ShapeRepair::insert_towards(Index triangle, const Point& p, double nearest) {
  constexpr unsigned most_steps = 30;
  constexpr double inside = -1e-9;
  Index at = triangle;
  for (unsigned step = 0; step < most_steps; ++step) {
    const auto corners = complex_.corners(at);
    const auto shares = barycentric(corners, p);
    const auto least = static_cast<unsigned>(std::min_element(shares.begin(), shares.end()) - shares.begin());
    if (shares[least] >= inside) break;
    const auto& c = complex_.triangles[at].corners;
    const Index a = c[(least + 1) % 3], b = c[(least + 2) % 3];
    if (const Index edge = complex_.edge_at(a, b); edge != none) {
      if (complex_.edges[edge].tip != none ||
          editor_.length(a, b) < 2 * shortest * editor_.size_of_edge(a, b))
        return false;
      const Index v = editor_.divide_curve_edge(edge);
      if (v != none) editor_.flip_around(v);
      return v != none;
    }
    const Index next = complex_.across(at, a, b);
    if (next == none) return false;
    at = next;
  }
  for (const Index v : complex_.triangles[at].corners)
    if (distance(complex_.vertices[v].point, p) < std::max(shortest * complex_.vertices[v].size, nearest))
      return false;
  const std::size_t before = complex_.vertices.size();
  if (divide_curve_beside(at, p)) return complex_.vertices.size() > before;
  const std::array<Index, 3> c = complex_.triangles[at].corners;
  for (unsigned i = 0; i < 3; ++i)
    if (const Index next = complex_.across(at, c[i], c[(i + 1) % 3]); next != none)
      if (divide_curve_beside(next, p)) return complex_.vertices.size() > before;
  const Index v = editor_.insert(at, p);
  if (v != none) editor_.flip_around(v);
  return v != none;
}

/// Returns whether all corners are on curves so close to each other that good angles would need edges shorter
/// than allowed (see `set_narrowest`).
bool ShapeRepair::too_narrow(Index triangle) const {
  const auto& c = complex_.triangles[triangle].corners;
  double size = INFINITY, longest = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if (complex_.vertices[c[i]].feature.dimension == 2) return false;
    size = std::min(size, complex_.vertices[c[i]].size);
    longest = std::max(longest, editor_.length(c[i], c[(i + 1) % 3]));
  }
  const double height = 2 * norm(area_vector(complex_.corners(triangle))) / longest;
  return height < narrowest_ * size;
}

bool ShapeRepair::refine(Index triangle) {
  if (too_narrow(triangle)) return false;
  const auto corners = complex_.corners(triangle);
  unsigned opposite = 0;  // the corner opposite the shortest side
  double shortest_side = INFINITY;
  for (unsigned i = 0; i < 3; ++i) {
    const double side = distance(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    if (side < shortest_side) {
      shortest_side = side;
      opposite = i;
    }
  }
  const Point middle = 0.5 * (corners[(opposite + 1) % 3] + corners[(opposite + 2) % 3]);
  Point p = circumcentre(corners);
  constexpr double least_share = 0.3;
  // At this height above the shortest side the angle opposite it is 28 degrees.
  const double high = 2 * shortest_side, height = distance(middle, p);
  if (height > high) p = middle + high / height * (p - middle);
  return insert_towards(triangle, p, least_share * shortest_side);
}

std::size_t ShapeRepair::run(std::size_t most_vertices) {
  constexpr unsigned most_passes = 40, collapsing_passes = 3, first_passes = 12;
  const double wanted = least_angle + margin;
  // The shape recorded for a triangle for which every attempt failed, refinement too. It is above every
  // wanted shape, so `improve` does not try the triangle either until something around it changes.
  constexpr double refined = 180;
  std::size_t limit = complex_.vertices.size() + most_vertices, fewest = complex_.triangles.size();
  std::vector<Index> poor_ones;
  Index first = 0;
  for (unsigned pass = 0; pass < most_passes && !execution_.cancelled(); ++pass) {
    bool changed = false;
    poor_ones = poor_triangles(wanted, poor_ones, first);
    first = static_cast<Index>(complex_.triangles.size());
    fewest = std::min(fewest, poor_ones.size());
    // Stop inserting vertices if they make more poor triangles than they cure, as between surfaces that
    // overlap.
    if (pass > first_passes && poor_ones.size() > fewest + fewest / 4 + 20) limit = 0;
    for (const Index t : poor_ones) {
      if (!poor(t, wanted) || tried(t, refined)) continue;
      // Moves alone cannot repair a triangle that is far from good, so there they come last.
      const bool near = editor_.shape(t) > 0.5 * wanted;
      // After some passes edges are no longer collapsed, so that new vertices stay.
      if (improve_connections(t, wanted, pass < collapsing_passes) || (near && move_corners(t)) ||
          (complex_.vertices.size() < limit && refine(t)) || (!near && move_corners(t)))
        changed = true;
      else
        note_tried(t, refined);
    }
    if (!changed) break;
  }
  return poor_triangles(least_angle, {}, 0).size();
}

bool ShapeRepair::approach(std::size_t most_vertices) {
  constexpr unsigned most_passes = 12;
  const std::size_t before = complex_.vertices.size(), limit = before + most_vertices;
  std::vector<std::size_t> seen(complex_.triangles.size(), 0);  // number of changes of the corners, plus 1
  for (unsigned pass = 0; pass < most_passes && !execution_.cancelled(); ++pass) {
    bool changed = false;
    seen.resize(complex_.triangles.size(), 0);
    for (Index t = 0; t < seen.size() && complex_.vertices.size() < limit; ++t) {
      if (!complex_.triangles[t].alive()) continue;
      const std::array<Index, 3> c = complex_.triangles[t].corners;
      std::size_t changes = 1;
      for (const Index v : c) changes += complex_.vertices[v].changes;
      if (std::exchange(seen[t], changes) == changes) continue;
      const unsigned side = editor_.side_too_far(t);
      if (side == 3) continue;
      const Index a = c[side], b = c[(side + 1) % 3];
      if (editor_.length(a, b) < 2 * shortest * editor_.size_of_edge(a, b)) continue;
      const Index edge = complex_.edge_at(a, b),
                  v = edge == none ? editor_.divide(a, b) : editor_.divide_curve_edge(edge);
      if (v == none) continue;
      editor_.flip_around(v);
      changed = true;
    }
    if (!changed && complex_.vertices.size() < limit) changed = approach_points(limit);
    if (!changed) break;
  }
  return complex_.vertices.size() > before;
}

bool ShapeRepair::approach_points(std::size_t limit) {
  bool changed = false;
  for (const auto& far : editor_.far_points()) {
    if (complex_.vertices.size() >= limit) break;
    const Index t = far.first;
    const Point& point = far.second;
    if (!complex_.triangles[t].alive()) continue;
    const auto& c = complex_.triangles[t].corners;
    const bool close = std::any_of(c.begin(), c.end(), [&](Index v) {
      return distance(complex_.vertices[v].point, point) < shortest * complex_.vertices[v].size;
    });
    if (close) continue;
    const Index v = editor_.insert(t, point);
    if (v == none) continue;
    editor_.flip_around(v);
    changed = true;
  }
  return changed;
}

void ShapeRepair::coarsen() {
  constexpr double short_edge = 0.75, longest = 1.4;
  const SurfaceEditor::CollapseRule rule{.longest = longest, .least_shape = wanted_shape};
  for (Index v = 0; v < complex_.vertices.size(); ++v) {
    if (complex_.vertices[v].triangles.empty() || complex_.vertices[v].feature.dimension == 0) continue;
    std::vector<std::pair<double, Index>> short_ones;
    for (const Index n : complex_.neighbours(v))
      if (const double share = editor_.length(v, n) / editor_.size_of_edge(v, n); share < short_edge)
        short_ones.emplace_back(share, n);
    std::sort(short_ones.begin(), short_ones.end());
    for (const auto& [share, n] : short_ones)
      if (editor_.collapse(v, n, rule)) break;
  }
}

}  // namespace collarmesh::shells
