#include "repair/winding_number.h"

#include <cmath>
#include <numbers>

namespace collarmesh::repairing {

namespace {

// At more than this distance, in radii of a node, the node's triangles are taken together.
constexpr double far = 3;

// Returns the signed solid angle of a triangle (Van Oosterom and Strackee 1983), positive behind it.
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
  if (!keys.empty()) build(keys, 0);
}

WindingNumber::Node WindingNumber::summary(Index first, Index count) const {
  Node node{{}, 0, {}, {}, first, count};
  double total = 0;
  for (Index i = first; i < first + count; ++i) {
    const double area = norm(area_vector(triangles_[i]));
    node.centre = node.centre + area * centroid(triangles_[i]);
    total += area;
  }
  node.centre = total > 0 ? (1 / total) * node.centre : centroid(triangles_[first]);
  for (Index i = first; i < first + count; ++i) {
    const WeightedTriangle& t = triangles_[i];
    const Vector area = t.weight * area_vector(t), arm = centroid(t) - node.centre;
    node.area = node.area + area;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) node.moment[3 * r + c] += arm[r] * area[c];
    for (const Point& corner : t.corners) node.radius = std::max(node.radius, distance(corner, node.centre));
  }
  return node;
}

Index WindingNumber::build(std::span<const SpatialKey> keys, Index first) {
  const auto number = static_cast<Index>(nodes_.size());
  const auto count = static_cast<Index>(keys.size());
  nodes_.push_back(summary(first, count));
  if (count <= leaf_size) return number;
  nodes_[number].count = 0;
  const std::size_t split = spatial_split(keys);
  build(keys.first(split), first);
  const Index right = build(keys.subspan(split), first + static_cast<Index>(split));
  nodes_[number].first = right;
  return number;
}

double WindingNumber::at(const Point& p, Index left_out) const {
  return nodes_.empty() ? 0 : at_node(0, p, left_out) / (4 * std::numbers::pi);
}

bool WindingNumber::is_on_another(const Point& p, Index left_out) const {
  return !nodes_.empty() && is_on_another(0, p, left_out);
}

bool WindingNumber::is_on_another(Index node, const Point& p, Index left_out) const {
  // Seen from a point on a triangle, the triangle covers half of the sphere.
  constexpr double half_sphere = 2 * std::numbers::pi - 1e-6;
  const Node& n = nodes_[node];
  if (distance(n.centre, p) > 1.001 * n.radius) return false;
  if (n.count == 0) return is_on_another(node + 1, p, left_out) || is_on_another(n.first, p, left_out);
  for (Index i = n.first; i < n.first + n.count; ++i)
    if (triangles_[i].number != left_out && std::fabs(solid_angle(triangles_[i], p)) > half_sphere)
      return true;
  return false;
}

double WindingNumber::at_node(Index node, const Point& p, Index left_out) const {
  const Node& n = nodes_[node];
  const Vector r = n.centre - p;
  const double distance = norm(r);
  if (distance > far * n.radius) {
    // Computes the first two terms of the expansion about the centre.
    const double cubed = distance * distance * distance;
    double trace = 0, along = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      trace += n.moment[4 * i];
      for (std::size_t j = 0; j < 3; ++j) along += r[i] * n.moment[3 * i + j] * r[j];
    }
    return (dot(r, n.area) + trace - 3 * along / (distance * distance)) / cubed;
  }
  if (n.count == 0) return at_node(node + 1, p, left_out) + at_node(n.first, p, left_out);
  double sum = 0;
  for (Index i = n.first; i < n.first + n.count; ++i)
    if (triangles_[i].number != left_out) sum += triangles_[i].weight * solid_angle(triangles_[i], p);
  return sum;
}

}  // namespace collarmesh::repairing
