#include "check/distance_tree.h"

#include <algorithm>
#include <numeric>

namespace collarmesh::checks {

namespace {

double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Vector ab = b - a, ap = p - a;
  const double squared = squared_norm(ab), along = dot(ap, ab);
  if (along <= 0 || !(squared > 0)) return squared_norm(ap);
  if (along >= squared) return squared_distance(p, b);
  return squared_norm(ap - along / squared * ab);
}

double squared_distance_to_triangle(const Point& p, const DistanceTree::Triangle& t) {
  const auto& [a, b, c] = t;
  const Vector ab = b - a, bc = c - b, ca = a - c;
  const Vector n = cross(ab, Point{} - ca);
  const double longest = std::max({squared_norm(ab), squared_norm(bc), squared_norm(ca)});
  const double nn = squared_norm(n);
  // The normal of a needle is noise; its edges are as near as its inside.
  if (nn > 1e-24 * longest * longest && dot(cross(ab, p - a), n) >= 0 && dot(cross(bc, p - b), n) >= 0 &&
      dot(cross(ca, p - c), n) >= 0) {
    const double h = dot(p - a, n);
    return h * h / nn;
  }
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

double squared_distance_to_box(const Point& p, const Box& box) {
  const auto beyond = [](double x, double low, double high) {
    return x < low ? low - x : x > high ? x - high : 0;
  };
  const Vector d{beyond(p.x, box.min.x, box.max.x), beyond(p.y, box.min.y, box.max.y),
                 beyond(p.z, box.min.z, box.max.z)};
  return squared_norm(d);
}

Point middle(const DistanceTree::Triangle& t) { return t[0] + t[1] + t[2]; }

}  // namespace

DistanceTree::DistanceTree(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), number_(triangles_.size()), place_(triangles_.size()) {
  std::iota(number_.begin(), number_.end(), Index{0});
  if (!triangles_.empty()) build(0, static_cast<Index>(triangles_.size()));
  std::vector<Triangle> ordered(triangles_.size());
  for (Index i = 0; i < number_.size(); ++i) {
    ordered[i] = triangles_[number_[i]];
    place_[number_[i]] = i;
  }
  triangles_ = std::move(ordered);
}

void DistanceTree::build(Index first, Index last) {
  const auto node = static_cast<Index>(nodes_.size());
  Box box, middles;
  for (Index i = first; i < last; ++i) {
    for (const Point& p : triangles_[number_[i]]) box.add(p);
    middles.add(middle(triangles_[number_[i]]));
  }
  nodes_.push_back({box, first, last - first});
  if (last - first <= leaf_size) return;
  const Vector extent = middles.max - middles.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const Index half = first + (last - first) / 2;
  std::nth_element(
      number_.begin() + first, number_.begin() + half, number_.begin() + last,
      [&](Index i, Index j) { return middle(triangles_[i])[axis] < middle(triangles_[j])[axis]; });
  build(first, half);
  nodes_[node].first = static_cast<Index>(nodes_.size());
  nodes_[node].count = 0;
  build(half, last);
}

double DistanceTree::squared_distance_to(Index node, const Point& p) const {
  return squared_distance_to_box(p, nodes_[node].box);
}

DistanceTree::Nearest DistanceTree::nearest(const Point& p, double enough, Index hint) const {
  if (nodes_.empty()) return {INFINITY, none};
  Index best = hint == none ? 0 : place_[hint];
  double least = squared_distance_to_triangle(p, triangles_[best]);
  struct Waiting {
    Index node;
    double squared;
  };
  std::array<Waiting, 64> stack;  // depth is at most log2 of the number of triangles
  std::size_t size = 0;
  stack[size++] = {0, squared_distance_to(0, p)};
  const double squared_enough = enough * enough;
  while (size > 0 && least > squared_enough) {
    const auto [index, squared] = stack[--size];
    if (squared >= least) continue;
    const Node& node = nodes_[index];
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const double d = squared_distance_to_triangle(p, triangles_[i]);
      if (d < least) {
        least = d;
        best = i;
      }
    }
    if (node.count != 0) continue;
    Waiting near{index + 1, squared_distance_to(index + 1, p)},
        far{node.first, squared_distance_to(node.first, p)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < least) stack[size++] = far;
    if (near.squared < least) stack[size++] = near;
  }
  return {std::sqrt(least), number_[best]};
}

}  // namespace collarmesh::checks
