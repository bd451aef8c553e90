#include "repair/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace collarmesh::repairing {

namespace {

// The triangles of a node are taken together at points whose distance from the node's centre exceeds this
// many of its radii.
constexpr double far = 3;

// Returns the signed solid angle of a triangle (Van Oosterom and Strackee 1983), positive for points behind
// it.
double solid_angle(const WeightedTriangle& t, const Point& p) {
  const Vector a = t.corners[0] - p, b = t.corners[1] - p, c = t.corners[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double above = dot(a, cross(b, c));
  const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(above, below);
}

Vector area_vector(const WeightedTriangle& t) {
  return 0.5 * cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
}

Point centroid(const WeightedTriangle& t) { return (1.0 / 3) * (t.corners[0] + t.corners[1] + t.corners[2]); }

}  // namespace

WindingNumber::WindingNumber(std::vector<WeightedTriangle> triangles) {
  std::vector<Point> centres;
  centres.reserve(triangles.size());
  for (const WeightedTriangle& t : triangles) centres.push_back(centroid(t));
  const std::vector<SpatialKey> keys = spatial_order(centres);
  triangles_.reserve(triangles.size());
  for (const SpatialKey& key : keys) triangles_.push_back(triangles[key.item]);
  if (keys.empty()) return;
  numbered_.reserve(triangles_.size());
  for (const WeightedTriangle& t : triangles_)
    numbered_.push_back({t.number, static_cast<Index>(numbered_.size())});
  std::ranges::stable_sort(numbered_, {}, &Numbered::number);
  constexpr Index leaf_size = 8;
  tree_.add(
      0, static_cast<Index>(keys.size()), leaf_size, spatial_splits(keys),
      [&](Index first, Index count) {
        return Range{triangles_, first, count};
      },
      [](const Range& a, const Range& b) {
        return Range{a.triangles, a.first, a.count + b.count};
      });
}

WindingNumber::Summary::Summary(const Range& range) : first(range.first), end(range.first + range.count) {
  const std::span triangles = std::span(range.triangles).subspan(range.first, range.count);
  double total = 0;
  for (const WeightedTriangle& t : triangles) {
    const double size = norm(area_vector(t));
    centre = centre + size * centroid(t);
    total += size;
  }
  centre = total > 0 ? (1 / total) * centre : centroid(triangles[0]);
  for (const WeightedTriangle& t : triangles) {
    const Vector weighted = t.weight * area_vector(t), arm = centroid(t) - centre;
    area = area + weighted;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) moment[3 * r + c] += arm[r] * weighted[c];
    for (const Point& corner : t.corners) radius = std::max(radius, distance(corner, centre));
  }
}

double WindingNumber::at(const Point& p, Index left_out) const {
  if (tree_.empty()) return 0;
  const auto from = std::ranges::lower_bound(numbered_, left_out, {}, &Numbered::number),
             to = std::ranges::upper_bound(numbered_, left_out, {}, &Numbered::number);
  return at_node(0, p, {from, to}) / (4 * std::numbers::pi);
}

bool WindingNumber::is_on_another(const Point& p, Index left_out) const {
  return !tree_.empty() && is_on_another(0, p, left_out);
}

bool WindingNumber::is_on_another(Index node, const Point& p, Index left_out) const {
  // Seen from a point on a triangle, the triangle covers half of the sphere.
  constexpr double half_sphere = 2 * std::numbers::pi - 1e-6;
  const Summary& n = tree_.bounds(node);
  if (distance(n.centre, p) > 1.001 * n.radius) return false;
  if (!tree_.is_leaf(node))
    return is_on_another(tree_.left(node), p, left_out) || is_on_another(tree_.right(node), p, left_out);
  for (Index i = tree_.first(node); i < tree_.end(node); ++i)
    if (triangles_[i].number != left_out && std::fabs(solid_angle(triangles_[i], p)) > half_sphere)
      return true;
  return false;
}

double WindingNumber::at_node(Index node, const Point& p, std::span<const Numbered> left_out) const {
  const Summary& n = tree_.bounds(node);
  const auto from = std::ranges::lower_bound(left_out, n.first, {}, &Numbered::place),
             to = std::ranges::lower_bound(left_out, n.end, {}, &Numbered::place);
  left_out = {from, to};  // only below this node
  if (left_out.size() == n.end - n.first) return 0;
  const Vector r = n.centre - p;
  const double distance = norm(r);
  if (distance > far * n.radius && left_out.empty()) {
    // Computes the first two terms of the expansion about the centre.
    const double cubed = distance * distance * distance;
    double trace = 0, along = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      trace += n.moment[4 * i];
      for (std::size_t j = 0; j < 3; ++j) along += r[i] * n.moment[3 * i + j] * r[j];
    }
    return (dot(r, n.area) + trace - 3 * along / (distance * distance)) / cubed;
  }
  if (!tree_.is_leaf(node))
    return at_node(tree_.left(node), p, left_out) + at_node(tree_.right(node), p, left_out);
  double sum = 0;
  for (Index i = tree_.first(node); i < tree_.end(node); ++i)
    if (left_out.empty() || triangles_[i].number != left_out[0].number)
      sum += triangles_[i].weight * solid_angle(triangles_[i], p);
  return sum;
}

}  // namespace collarmesh::repairing
