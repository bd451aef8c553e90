#include "facets/shells.h"

#include <algorithm>
#include <cmath>

#include "delaunay/predicates.h"
#include "facets/exact.h"

namespace collarmesh::facets {

namespace {

// The triangles around an edge, sorted by angle from the first one: counterclockwise about the edge from its
// smaller to its larger point (right-hand rule).
class Fan {
 public:
  Fan(const ComplexDraft& draft, const EdgeTable& edges, Index edge)
      : draft_(draft),
        a_(draft.points[edges.ends(edge)[0]]),
        b_(draft.points[edges.ends(edge)[1]]),
        sides_(edges.sides(edge).begin(), edges.sides(edge).end()) {
    reference_ = apex_point(sides_[0]);
    std::sort(sides_.begin() + 1, sides_.end(), [this](Index s, Index t) { return before(s, t); });
  }
  const std::vector<Index>& sides() const { return sides_; }

 private:
  const Point& apex_point(Index side) const { return draft_.points[apex(draft_.triangles, side)]; }

  // Returns the sector of a point's angle: 0 at the reference, 1 below 180 degrees, 2 at 180, 3 above.
  int sector(const Point& c) const {
    const int o = predicates::orientation(a_, b_, reference_, c);
    if (o != 0) return o > 0 ? 1 : 3;
    return same_side(a_, b_, reference_, c) ? 0 : 2;
  }

  bool before(Index s, Index t) const {
    const Point &c = apex_point(s), &d = apex_point(t);
    const int cs = sector(c), ds = sector(d);
    if (cs != ds) return cs < ds;
    const int o = cs % 2 == 0 ? 0 : predicates::orientation(a_, b_, c, d);
    return o != 0 ? o > 0 : s < t;
  }

  const ComplexDraft& draft_;
  Point a_, b_, reference_;
  std::vector<Index> sides_;
};

// Returns the side of the triangle (front or back) that faces larger angles about the edge; if not `larger`,
// the other one.
Index side_towards(const ComplexDraft& draft, Index side, bool larger) {
  return ascending(draft.triangles, side) == larger ? front_side(side / 3) : back_side(side / 3);
}

}  // namespace

DisjointSets find_shells(const ComplexDraft& draft, const EdgeTable& edges) {
  DisjointSets shells(2 * draft.triangles.size() + 1);
  const auto join = [&](Index side, Index next) {
    shells.unite(side_towards(draft, side, true), side_towards(draft, next, false));
  };
  for (Index e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() <= 2) {
      join(sides.front(), sides.back());
      join(sides.back(), sides.front());
      continue;
    }
    const Fan fan(draft, edges, e);
    for (std::size_t i = 0; i < sides.size(); ++i) join(fan.sides()[i], fan.sides()[(i + 1) % sides.size()]);
  }
  return shells;
}

std::optional<std::vector<LineCaster::Crossing>> LineCaster::cast(const Point& p, const Point& q) const {
  std::vector<Crossing> crossings;
  bool degenerate = false;
  boxes_.for_each_near_segment(p, q, [&](Index t) {
    if (t >= draft_.triangles.size()) return;
    const Meeting meeting = meet(t, p, q);
    if (meeting == Meeting::degenerate) degenerate = true;
    if (meeting == Meeting::forward || meeting == Meeting::backward)
      crossings.push_back({t, meeting == Meeting::forward});
  });
  if (degenerate) return std::nullopt;
  const auto corners = [&](const Crossing& c) {
    return std::array<Point, 3>{draft_.corner(c.triangle, 0), draft_.corner(c.triangle, 1),
                                draft_.corner(c.triangle, 2)};
  };
  std::ranges::sort(crossings, [&](const Crossing& c, const Crossing& d) {
    const int order = compare_crossings(p, q, corners(c), corners(d));
    return order != 0 ? order < 0 : c.triangle < d.triangle;
  });
  return crossings;
}

LineCaster::Meeting LineCaster::meet(Index triangle, const Point& p, const Point& q) const {
  using predicates::orientation;
  const Point &a = draft_.corner(triangle, 0), &b = draft_.corner(triangle, 1),
              &c = draft_.corner(triangle, 2);
  const int from = orientation(a, b, c, p), to = orientation(a, b, c, q);
  if (from * to > 0) return Meeting::none;
  const auto [low, high] =
      std::minmax({orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a)});
  if (low < 0 && high > 0) return Meeting::none;
  if (low * high == 0 || from * to == 0) return Meeting::degenerate;
  return from < 0 ? Meeting::forward : Meeting::backward;
}

Vector generic_direction(std::size_t attempt) {
  // Steps by the golden ratio and by the square root of two spread the directions over the sphere.
  const double n = static_cast<double>(attempt) + 0.2718281828;
  const double z = 1 - 2 * std::fmod(0.6180339887498949 * n, 1.0);
  const double turn = 6.283185307179586 * std::fmod(0.4142135623730951 * n, 1.0);
  const double r = std::sqrt(std::fmax(0.0, 1 - z * z));
  return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace collarmesh::facets
