#include "constrained/ladders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/disjoint_sets.h"
#include "common/edge_key.h"

namespace collarmesh {

namespace constrained {
namespace {

// Edges longer than this factor times the size are long.
constexpr double long_edge = 1.6;
// The long edges of a needle are longer than this factor times its short one.
constexpr double narrow = 4;
// Limit of added points: `rail_points_per_point` times the number of points of the complex, plus
// `some_rail_points`.
constexpr std::size_t rail_points_per_point = 100, some_rail_points = 20'000;
// If the sum of the angles opposite a diagonal differs from pi by at most `open_choice`, both diagonals are
// equally good. `rounding_of_angles` is a margin for rounding. Radians.
constexpr double open_choice = 1e-3, rounding_of_angles = 1e-6;
constexpr unsigned most_flips_per_triangle = 20;

double angle_at(const Point& at, const Point& a, const Point& b) {
  return std::atan2(norm(cross(a - at, b - at)), dot(a - at, b - at));
}

class Ladders {
 public:
  Ladders(const Plc& plc, double size, const std::function<double(Index)>& may_move, const Vector& direction)
      : made_(plc),
        size_(size),
        may_move_(may_move),
        direction_(direction),
        first_point_(static_cast<Index>(plc.points.size())) {
    for (Index t = 0; t < plc.triangles.size(); ++t) {
      triangles_.push_back({plc.triangles[t].points, plc.triangles[t].patch, t});
      for (unsigned k = 0; k < 3; ++k) attach(t, k);
    }
    for (const Plc::Curve& curve : plc.curves)
      for_each_segment(curve, [&](Index a, Index b) {
        if (const auto at = edges_.find(edge_key(a, b)); at != edges_.end()) at->second.is_flippable = false;
      });
  }

  Plc run() {
    if (!needles_prevail()) return std::move(made_);
    find_diagonals();
    find_rails();
    std::size_t points = 0;
    for (const Rail& rail : rails_) points += rail.pieces - 1;
    if (points == 0 || points > rail_points_per_point * made_.points.size() + some_rail_points)
      return std::move(made_);
    for (const Rail& rail : rails_) divide(rail);
    make_rungs();
    choose_diagonals();
    store();
    return std::move(made_);
  }

 private:
  struct Triangle {
    std::array<Index, 3> points;
    Index patch, origin;  // origin: triangle of the complex
  };
  struct Edge {
    std::vector<Index> triangles;
    bool is_flippable = true;  // false: on a curve or a rail
    bool is_diagonal = false;
  };
  struct Rail {
    Index a, b;
    std::size_t pieces;
  };
  /// An edge between two triangles, and the corners opposite it.
  struct Quad {
    Index a, b, c, d;
    Index first, second;  // triangles
  };

  template <class Visit>
  void for_each_segment(const Plc::Curve& curve, const Visit& visit) const {
    const auto& p = curve.points;
    for (std::size_t i = 1; i < p.size(); ++i) visit(p[i - 1], p[i]);
    if (curve.closed) visit(p.back(), p.front());
  }
  void attach(Index triangle, unsigned k) {
    const auto& p = triangles_[triangle].points;
    const std::uint64_t key = edge_key(p[k], p[(k + 1) % 3]);
    const auto [at, is_new] = edges_.try_emplace(key);
    at->second.triangles.push_back(triangle);
    if (is_new) keys_.push_back(key);
  }
  const Point& point(Index v) const { return made_.points[v]; }
  double length(Index a, Index b) const { return distance(point(a), point(b)); }
  bool is_long(Index a, Index b) const { return length(a, b) > long_edge * size_; }
  bool is_smooth(Index triangle) const { return !made_.patches[triangles_[triangle].patch].planar; }

  /// Returns whether a triangle of a smooth patch has two long edges and a short one.
  bool is_needle(Index triangle) const {
    const auto& [a, b, c] = triangles_[triangle].points;
    const double ab = length(a, b), bc = length(b, c), ca = length(c, a), shortest = std::min({ab, bc, ca}),
                 middle = std::max(std::min(ab, bc), std::min(std::max(ab, bc), ca));
    return is_smooth(triangle) && shortest <= long_edge * size_ && middle > long_edge * size_ &&
           middle > narrow * shortest;
  }
  /// Returns whether most of the surface is made of needles. Ladders on a small part of the surface help
  /// little, and the attempt costs time.
  bool needles_prevail() const {
    constexpr double least_share = 0.5;
    double all = 0, needles = 0;
    for (Index t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t].points;
      const double area = norm(cross(point(b) - point(a), point(c) - point(a)));
      all += area;
      if (is_needle(t)) needles += area;
    }
    return needles >= least_share * all;
  }
  bool is_longest_in(Index triangle, Index a, Index b) const {
    const auto& [p, q, r] = triangles_[triangle].points;
    return length(a, b) >= std::max({length(p, q), length(q, r), length(r, p)});
  }
  Index third(Index triangle, Index a, Index b) const {
    const auto& p = triangles_[triangle].points;
    return *std::ranges::find_if(p, [&](Index v) { return v != a && v != b; });
  }

  /// Finds the quadrilateral of an edge. Returns false unless the edge can be replaced by the other diagonal
  /// and this moves the surface by no more than `may_move_` permits.
  bool find_flat_quad(std::uint64_t key, Quad& quad) const {
    const auto found = edges_.find(key);
    if (found == edges_.end()) return false;
    const Edge& edge = found->second;
    if (!edge.is_flippable || edge.triangles.size() != 2) return false;
    const Index first = edge.triangles[0], second = edge.triangles[1];
    if (!is_smooth(first) || triangles_[first].patch != triangles_[second].patch) return false;
    const auto a = static_cast<Index>(key >> 32U), b = static_cast<Index>(key);
    quad = {a, b, third(first, a, b), third(second, a, b), first, second};
    if (quad.c == quad.d || edges_.contains(edge_key(quad.c, quad.d))) return false;
    const Point &pa = point(a), &pb = point(b), &pc = point(quad.c), &pd = point(quad.d);
    const Vector ab = pb - pa, cd = pd - pc, across = cross(ab, cd);
    const double crossing = norm(across);
    if (!(crossing > 0) ||
        std::fabs(dot(pc - pa, across)) >
            crossing * std::min(may_move_(triangles_[first].origin), may_move_(triangles_[second].origin)))
      return false;
    // The two ends of each diagonal are on opposite sides of the other diagonal.
    const auto parts = [&](const Point& from, const Vector& along, const Point& p, const Point& q) {
      return dot(cross(along, p - from), across) * dot(cross(along, q - from), across) < 0;
    };
    return parts(pa, ab, pc, pd) && parts(pc, cd, pa, pb);
  }

  /// Marks the diagonals of strips: at most one edge of each needle, if possible the longest.
  void find_diagonals() {
    std::vector<std::tuple<bool, double, std::uint64_t>> candidates;
    for (const std::uint64_t key : keys_) {
      Quad quad;
      if (!is_long(static_cast<Index>(key >> 32U), static_cast<Index>(key)) || !find_flat_quad(key, quad))
        continue;
      if (!is_needle(quad.first) || !is_needle(quad.second)) continue;
      const bool longest =
          is_longest_in(quad.first, quad.a, quad.b) && is_longest_in(quad.second, quad.a, quad.b);
      candidates.emplace_back(!longest, -length(quad.a, quad.b), key);
    }
    std::ranges::sort(candidates);
    std::vector<bool> has_diagonal(triangles_.size(), false);
    for (const auto& candidate : candidates) {
      Edge& edge = edges_.at(std::get<2>(candidate));
      if (has_diagonal[edge.triangles[0]] || has_diagonal[edge.triangles[1]]) continue;
      edge.is_diagonal = true;
      for (const Index t : edge.triangles) has_diagonal[t] = true;
    }
  }

  /// Finds the long sides of strips. The long sides of strips beside each other get equally many pieces.
  void find_rails() {
    std::unordered_map<std::uint64_t, Index> number;
    std::vector<std::uint64_t> keys;
    for (const std::uint64_t key : keys_)
      if (is_long(static_cast<Index>(key >> 32U), static_cast<Index>(key)) &&
          std::ranges::any_of(edges_.at(key).triangles, [&](Index t) { return is_needle(t); })) {
        number.emplace(key, static_cast<Index>(keys.size()));
        keys.push_back(key);
      }
    DisjointSets strips(keys.size());
    for (Index t = 0; t < triangles_.size(); ++t) {
      if (!is_needle(t)) continue;
      Index other = none;
      for (unsigned k = 0; k < 3; ++k) {
        const auto at = number.find(edge_key(triangles_[t].points[k], triangles_[t].points[(k + 1) % 3]));
        if (at == number.end()) continue;
        if (other != none) strips.unite(other, at->second);
        other = at->second;
      }
    }
    std::vector<double> longest(keys.size(), 0);
    for (Index i = 0; i < keys.size(); ++i) {
      if (edges_.at(keys[i]).is_diagonal) continue;
      double& most = longest[strips.find(i)];
      most = std::max(most, length(static_cast<Index>(keys[i] >> 32U), static_cast<Index>(keys[i])));
    }
    for (Index i = 0; i < keys.size(); ++i) {
      if (edges_.at(keys[i]).is_diagonal) continue;
      rails_.push_back(
          {static_cast<Index>(keys[i] >> 32U), static_cast<Index>(keys[i]),
           static_cast<std::size_t>(std::ceil(longest[strips.find(i)] / size_ - rounding_of_angles))});
    }
  }

  /// Divides a rail, and each triangle at it into a fan.
  void divide(const Rail& rail) {
    const std::uint64_t key = edge_key(rail.a, rail.b);
    std::vector<Index>& chain = chains_[key];
    chain.push_back(rail.a);
    const Point from = point(rail.a), to = point(rail.b);
    for (std::size_t i = 1; i < rail.pieces; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(rail.pieces);
      chain.push_back(static_cast<Index>(made_.points.size()));
      made_.points.push_back(from + share * (to - from));
    }
    chain.push_back(rail.b);
    const std::vector<Index> at_rail = edges_.at(key).triangles;
    edges_.erase(key);
    for (const Index t : at_rail) make_fan(t, chain);
    for (std::size_t i = 1; i < chain.size(); ++i)
      edges_.at(edge_key(chain[i - 1], chain[i])).is_flippable = false;
  }

  void make_fan(Index t, const std::vector<Index>& chain) {
    const Index a = chain.front(), b = chain.back(), c = third(t, a, b);
    const Triangle whole = triangles_[t];
    for (const Index end : {a, b}) std::erase(edges_.at(edge_key(end, c)).triangles, t);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      Triangle part = whole;
      for (Index& v : part.points) v = v == a ? chain[i - 1] : v == b ? chain[i] : v;
      const Index number = i == 1 ? t : static_cast<Index>(triangles_.size());
      if (i == 1)
        triangles_[t] = part;
      else
        triangles_.push_back(part);
      for (unsigned k = 0; k < 3; ++k) attach(number, k);
    }
  }

  /// Replaces an edge by the other diagonal of its quadrilateral.
  void flip(std::uint64_t key, const Quad& quad) {
    for (const Index t : {quad.first, quad.second})
      for (unsigned k = 0; k < 3; ++k) {
        const auto& p = triangles_[t].points;
        std::erase(edges_.at(edge_key(p[k], p[(k + 1) % 3])).triangles, t);
      }
    edges_.erase(key);
    std::ranges::replace(triangles_[quad.first].points, quad.b, quad.d);
    std::ranges::replace(triangles_[quad.second].points, quad.a, quad.c);
    for (const Index t : {quad.first, quad.second})
      for (unsigned k = 0; k < 3; ++k) attach(t, k);
  }

  double opposite_angles(const Quad& quad) const {
    return angle_at(point(quad.c), point(quad.a), point(quad.b)) +
           angle_at(point(quad.d), point(quad.a), point(quad.b));
  }
  bool is_at_rail(const Quad& quad) const {
    return std::max({quad.a, quad.b, quad.c, quad.d}) >= first_point_;
  }

  /// Flips edges between fans, so that rungs join the sides of strips.
  void make_rungs() {
    std::vector<std::uint64_t> to_do = keys_;
    std::size_t left = most_flips_per_triangle * triangles_.size();
    while (!to_do.empty() && left > 0) {
      const std::uint64_t key = to_do.back();
      to_do.pop_back();
      Quad quad;
      if (!find_flat_quad(key, quad) || !is_at_rail(quad) ||
          opposite_angles(quad) < std::numbers::pi + rounding_of_angles)
        continue;
      flip(key, quad);
      --left;
      for (const Index end : {quad.a, quad.b})
        for (const Index tip : {quad.c, quad.d}) to_do.push_back(edge_key(end, tip));
    }
  }

  /// If both diagonals of a quadrilateral are equally good, chooses the one that extends farther in the given
  /// direction, so that diagonals on opposite walls do not cross.
  void choose_diagonals() {
    const std::vector<std::uint64_t> keys = keys_;
    for (const std::uint64_t key : keys) {
      Quad quad;
      if (!find_flat_quad(key, quad) || !is_at_rail(quad) ||
          std::fabs(opposite_angles(quad) - std::numbers::pi) > open_choice)
        continue;
      const auto along = [&](Index a, Index b) { return std::fabs(dot(point(b) - point(a), direction_)); };
      if (along(quad.c, quad.d) > along(quad.a, quad.b)) flip(key, quad);
    }
  }

  void store() {
    std::ranges::stable_sort(triangles_, {}, &Triangle::patch);
    made_.triangles.clear();
    for (Plc::Patch& patch : made_.patches) patch.triangle_count = 0;
    for (const Triangle& t : triangles_) {
      Plc::Patch& patch = made_.patches[t.patch];
      if (patch.triangle_count++ == 0) patch.first_triangle = static_cast<Index>(made_.triangles.size());
      made_.triangles.push_back({t.points, t.patch});
    }
    for (Plc::Curve& curve : made_.curves) store(curve);
  }

  void store(Plc::Curve& curve) const {
    std::vector<Index> points{curve.points.front()};
    for_each_segment(curve, [&](Index a, Index b) {
      if (const auto chain = chains_.find(edge_key(a, b)); chain != chains_.end()) {
        std::vector<Index> between(chain->second.begin() + 1, chain->second.end() - 1);
        if (chain->second.front() != a) std::ranges::reverse(between);
        points.insert(points.end(), between.begin(), between.end());
      }
      points.push_back(b);
    });
    if (curve.closed) points.pop_back();
    curve.points = std::move(points);
  }

  Plc made_;
  double size_;
  const std::function<double(Index)>& may_move_;
  Vector direction_;
  Index first_point_;  // the first point that was added
  std::vector<Triangle> triangles_;
  std::unordered_map<std::uint64_t, Edge> edges_;
  std::vector<std::uint64_t> keys_;  // keys of all edges, also of removed ones, as they were made
  std::vector<Rail> rails_;
  std::unordered_map<std::uint64_t, std::vector<Index>> chains_;  // by rail: its points
};

}  // namespace
}  // namespace constrained

Plc with_ladders(const Plc& plc, double size, const std::function<double(Index)>& may_move,
                 const Vector& diagonals) {
  return constrained::Ladders(plc, size, may_move, diagonals).run();
}

}  // namespace collarmesh
