#include "flat_triangles.h"

#include <algorithm>
#include <unordered_map>

namespace collarmesh::brep {

namespace {

class Flipper {
 public:
  Flipper(const std::vector<Point>& points, double height, std::vector<std::array<Index, 3>>& triangles)
      : points_(points), height_(height), triangles_(triangles) {
    for (Index t = 0; t < triangles_.size(); ++t) add_sides(t);
  }

  void run() {
    std::vector<Index> flat;
    for (Index t = 0; t < triangles_.size(); ++t)
      if (side_with_corner_on_it(t) != none) flat.push_back(t);
    for (std::size_t left = 8 * flat.size(); left > 0 && !flat.empty(); --left) {
      const Index t = flat.back();
      flat.pop_back();
      const Index side = side_with_corner_on_it(t);
      const Index other = side == none ? none : flip(t, side);
      if (other == none) continue;
      for (const Index changed : {t, other})
        if (side_with_corner_on_it(changed) != none) flat.push_back(changed);
    }
  }

 private:
  static std::uint64_t key(Index from, Index to) { return std::uint64_t{from} << 32U | to; }
  Index corner(Index t, Index i) const { return triangles_[t][i % 3]; }

  void add_sides(Index t) {
    for (Index i = 0; i < 3; ++i) triangle_at_[key(corner(t, i), corner(t, i + 1))] = t;
  }
  void remove_sides(Index t) {
    for (Index i = 0; i < 3; ++i) triangle_at_.erase(key(corner(t, i), corner(t, i + 1)));
  }
  Index triangle_at(Index from, Index to) const {
    const auto found = triangle_at_.find(key(from, to));
    return found == triangle_at_.end() ? none : found->second;
  }

  /// Returns the side i that passes through the opposite corner; none if there is none.
  Index side_with_corner_on_it(Index t) const {
    Index longest = 0;
    for (Index i = 1; i < 3; ++i)
      if (length(t, i) > length(t, longest)) longest = i;
    const Point &a = points_[corner(t, longest)], &b = points_[corner(t, longest + 1)],
                &c = points_[corner(t, longest + 2)];
    return norm(cross(b - a, c - a)) <= height_ * length(t, longest) ? longest : none;
  }
  double length(Index t, Index i) const { return distance(points_[corner(t, i)], points_[corner(t, i + 1)]); }

  /// Flips a side. Returns the triangle on its other side; none if the side stays.
  Index flip(Index t, Index side) {
    const Index a = corner(t, side), b = corner(t, side + 1), c = corner(t, side + 2);
    const Index other = triangle_at(b, a);
    if (other == none) return none;
    Index d = none;
    for (const Index p : triangles_[other])
      if (p != a && p != b) d = p;
    if (d == none || d == c || triangle_at(c, d) != none || triangle_at(d, c) != none) return none;
    remove_sides(t);
    remove_sides(other);
    triangles_[t] = {a, d, c};
    triangles_[other] = {d, b, c};
    add_sides(t);
    add_sides(other);
    return other;
  }

  const std::vector<Point>& points_;
  double height_;
  std::vector<std::array<Index, 3>>& triangles_;
  std::unordered_map<std::uint64_t, Index> triangle_at_;  // by directed side
};

}  // namespace

void flip_flat_triangles(const std::vector<Point>& points, double height,
                         std::vector<std::array<Index, 3>>& triangles) {
  Flipper(points, height, triangles).run();
}

}  // namespace collarmesh::brep
