#include "folded_triangles.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

namespace collarmesh::brep {

namespace {

using Triangle = std::array<Index, 3>;

/// A changing set of triangles that finds the triangle at each directed side.
class SidedTriangles {
 protected:
  /// The numbers of two triangles with a common side, and the triangles that replace them if the side is
  /// flipped.
  struct Flip {
    std::array<Index, 2> numbers;
    std::array<Triangle, 2> triangles;
  };

  /// Keeps references to both arguments.
  SidedTriangles(const std::vector<Point>& points, std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles) {
    for (Index t = 0; t < triangles_.size(); ++t) add_sides(t);
  }

  Index corner(Index t, Index i) const { return triangles_[t][i % 3]; }
  Index triangle_at(Index from, Index to) const {
    const auto found = triangle_at_.find(key(from, to));
    return found == triangle_at_.end() ? none : found->second;
  }
  /// Returns the neighbour of triangle `t` at its side `i`; none at the border.
  Index across(Index t, Index i) const { return triangle_at(corner(t, i + 1), corner(t, i)); }

  /// Returns the flip of a side; nothing if the new side exists already or the side is at the border.
  std::optional<Flip> flip_of(Index t, Index side) const {
    const Index a = corner(t, side), b = corner(t, side + 1), c = corner(t, side + 2),
                other = across(t, side);
    if (other == none) return std::nullopt;
    Index d = none;
    for (const Index p : triangles_[other])
      if (p != a && p != b) d = p;
    if (d == none || d == c || triangle_at(c, d) != none || triangle_at(d, c) != none) return std::nullopt;
    return Flip{{t, other}, {Triangle{a, d, c}, Triangle{d, b, c}}};
  }

  void add_sides(Index t) {
    for (Index i = 0; i < 3; ++i) triangle_at_[key(corner(t, i), corner(t, i + 1))] = t;
  }
  void remove_sides(Index t) {
    for (Index i = 0; i < 3; ++i) triangle_at_.erase(key(corner(t, i), corner(t, i + 1)));
  }

  const std::vector<Point>& points_;
  std::vector<Triangle>& triangles_;

 private:
  static std::uint64_t key(Index from, Index to) { return std::uint64_t{from} << 32U | to; }

  std::unordered_map<std::uint64_t, Index> triangle_at_;  // by directed side
};

class Flipper : SidedTriangles {
 public:
  Flipper(const std::vector<Point>& points, double height, std::vector<Triangle>& triangles)
      : SidedTriangles(points, triangles), height_(height) {}

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
  /// Returns the longest side if the opposite corner is within `height_` of it; else none.
  Index side_with_corner_on_it(Index t) const {
    Index longest = 0;
    for (Index i = 1; i < 3; ++i)
      if (length(t, i) > length(t, longest)) longest = i;
    const Point &a = points_[corner(t, longest)], &b = points_[corner(t, longest + 1)],
                &c = points_[corner(t, longest + 2)];
    return norm(cross(b - a, c - a)) <= height_ * length(t, longest) ? longest : none;
  }
  double length(Index t, Index i) const { return distance(points_[corner(t, i)], points_[corner(t, i + 1)]); }

  /// Flips a side. Returns the number of the neighbour, which changes, too; none if the side stays.
  Index flip(Index t, Index side) {
    const std::optional<Flip> found = flip_of(t, side);
    if (!found) return none;
    for (const Index changed : found->numbers) remove_sides(changed);
    for (std::size_t k = 0; k < 2; ++k) triangles_[found->numbers[k]] = found->triangles[k];
    for (const Index changed : found->numbers) add_sides(changed);
    return found->numbers[1];
  }

  double height_;
};

/// A remover of the folds of a face's triangles, by edge flips and edge collapses.
class Unfolder : SidedTriangles {
 public:
  Unfolder(const std::vector<Point>& points, std::vector<Triangle>& triangles)
      : SidedTriangles(points, triangles), gone_(triangles.size(), false) {}

  void run(Index first_inner, double distance) {
    std::vector<Index> folded = folded_triangles();
    constexpr std::size_t tries_by_fold = 16;
    for (std::size_t left = tries_by_fold * folded.size(); left > 0 && !folded.empty(); --left) {
      const Index t = folded.back();
      folded.pop_back();
      if (gone_[t] || folds_at(t) == 0) continue;
      changed_.clear();
      if (!flip_one(t) && !collapse_one(t, first_inner, distance)) continue;
      for (const Index changed : changed_)
        if (!gone_[changed] && folds_at(changed) > 0) folded.push_back(changed);
    }
    drop_gone();
  }

 private:
  Vector normal(const Triangle& t) const {
    return cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
  }
  bool folded(const Triangle& s, const Triangle& t) const { return dot(normal(s), normal(t)) < 0; }

  std::vector<Index> folded_triangles() const {
    std::vector<Index> folded;
    for (Index t = 0; t < triangles_.size(); ++t)
      if (folds_at(t) > 0) folded.push_back(t);
    return folded;
  }
  std::size_t folds_at(Index t) const { return folds_around(std::span(&t, 1), {}); }

  /// Returns at how many sides of the triangles `some` the surface is folded. If `as` is not empty, counts as
  /// if these triangles, which have the same border, had replaced `some`.
  std::size_t folds_around(std::span<const Index> some, std::span<const Triangle> as) const {
    std::vector<Triangle> shapes(as.begin(), as.end());
    if (as.empty())
      for (const Index t : some) shapes.push_back(triangles_[t]);
    std::size_t folds = 0;
    for (std::size_t k = 0; k < shapes.size(); ++k)
      for (Index i = 0; i < 3; ++i) {
        const Index from = shapes[k][(i + 1) % 3], to = shapes[k][i];
        const auto inner = std::find_if(shapes.begin(), shapes.end(), [&](const Triangle& s) {
          return (s[0] == from && s[1] == to) || (s[1] == from && s[2] == to) || (s[2] == from && s[0] == to);
        });
        if (inner != shapes.end()) {
          if (inner - shapes.begin() < static_cast<std::ptrdiff_t>(k) && folded(*inner, shapes[k])) ++folds;
          continue;
        }
        const Index other = triangle_at(from, to);
        if (other != none && std::find(some.begin(), some.end(), other) == some.end() &&
            folded(triangles_[other], shapes[k]))
          ++folds;
      }
    return folds;
  }

  void replace(std::span<const Index> some, std::span<const Triangle> by) {
    for (const Index t : some) remove_sides(t);
    for (std::size_t k = 0; k < some.size(); ++k) {
      gone_[some[k]] = k >= by.size();
      if (k < by.size()) triangles_[some[k]] = by[k];
    }
    for (std::size_t k = 0; k < by.size(); ++k) add_sides(some[k]);
    for (std::size_t k = 0; k < by.size(); ++k) {
      changed_.push_back(some[k]);
      for (Index i = 0; i < 3; ++i)
        if (const Index other = across(some[k], i); other != none) changed_.push_back(other);
    }
  }

  /// Flips a side of a triangle if that reduces the number of folds. Returns whether one was flipped.
  bool flip_one(Index t) {
    for (Index i = 0; i < 3; ++i) {
      const std::optional<Flip> flip = flip_of(t, i);
      if (!flip || folds_around(flip->numbers, flip->triangles) >= folds_around(flip->numbers, {})) continue;
      replace(flip->numbers, flip->triangles);
      return true;
    }
    return false;
  }

  /// Returns the triangles around a point, in order; empty if they do not close a ring, or are more than
  /// `most_in_star`.
  std::vector<Index> star(Index t, Index p) const {
    std::vector<Index> around;
    for (Index next = t; next != none && around.size() < most_in_star;) {
      around.push_back(next);
      const auto& c = triangles_[next];
      const auto at = static_cast<Index>(std::find(c.begin(), c.end(), p) - c.begin());
      next = across(next, (at + 2) % 3);
      if (next == t) return around;
    }
    return {};
  }

  /// Collapses an edge at a corner of a triangle that lies inside the face, if that reduces the number of
  /// folds and the surface stays near the corner. Returns whether one was collapsed.
  bool collapse_one(Index t, Index first_inner, double distance) {
    for (Index i = 0; i < 3; ++i) {
      const Index p = corner(t, i);
      if (p < first_inner) continue;
      const std::vector<Index> around = star(t, p);
      if (around.size() < 3) continue;
      const std::size_t before = folds_around(around, {});
      for (const Index s : around) {
        const auto& c = triangles_[s];
        const auto at = static_cast<Index>(std::find(c.begin(), c.end(), p) - c.begin());
        const std::vector<Triangle> fan = fan_from(c[(at + 1) % 3], around, p);
        if (fan.empty() || !keeps_near(p, fan, distance) || folds_around(around, fan) >= before) continue;
        replace(around, fan);
        return true;
      }
    }
    return false;
  }

  /// Returns triangles that fill a star after its centre is removed, all with the corner `apex`; empty if
  /// there are none or one of their new edges exists already.
  std::vector<Triangle> fan_from(Index apex, const std::vector<Index>& around, Index centre) const {
    std::vector<Triangle> fan;
    for (const Index s : around) {
      Triangle turned = triangles_[s];
      std::replace(turned.begin(), turned.end(), centre, apex);
      if (turned[0] == turned[1] || turned[1] == turned[2] || turned[2] == turned[0]) continue;
      fan.push_back(turned);
    }
    if (fan.size() + 2 != around.size()) return {};
    for (std::size_t k = 0; k < fan.size(); ++k)
      for (Index i = 0; i < 3; ++i) {
        const Index other = triangle_at(fan[k][i], fan[k][(i + 1) % 3]);
        if (other != none && std::find(around.begin(), around.end(), other) == around.end()) return {};
      }
    return fan;
  }

  /// Returns whether a point is within the limit of a corner, or projects into a triangle from within the
  /// limit of its plane. Triangles without area do not count.
  bool keeps_near(Index p, const std::vector<Triangle>& fan, double distance_limit) const {
    return std::any_of(fan.begin(), fan.end(), [&](const Triangle& t) {
      const Vector n = normal(t);
      const double nn = squared_norm(n);
      if (!(nn > 0)) return false;
      bool inside = true;
      for (Index i = 0; i < 3; ++i) {
        const Point &a = points_[t[i]], &b = points_[t[(i + 1) % 3]];
        if (distance(points_[p], a) <= distance_limit) return true;
        inside = inside && dot(cross(b - a, points_[p] - a), n) >= 0;
      }
      return inside && std::fabs(dot(points_[p] - points_[t[0]], n)) <= distance_limit * std::sqrt(nn);
    });
  }

  void drop_gone() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (!gone_[t]) triangles_[kept++] = triangles_[t];
    triangles_.resize(kept);
  }

  static constexpr std::size_t most_in_star = 64;

  std::vector<bool> gone_;
  std::vector<Index> changed_;
};

}  // namespace

void flip_flat_triangles(const std::vector<Point>& points, double height,
                         std::vector<std::array<Index, 3>>& triangles) {
  Flipper(points, height, triangles).run();
}

void unfold(const std::vector<Point>& points, Index first_inner, double distance,
            std::vector<Triangle>& triangles) {
  Unfolder(points, triangles).run(first_inner, distance);
}

}  // namespace collarmesh::brep
