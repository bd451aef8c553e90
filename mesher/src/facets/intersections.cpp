#include "facets/intersections.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "delaunay/predicates.h"
#include "facets/exact.h"

namespace collarmesh::facets {

namespace {

using predicates::orientation;

// Returns a coordinate whose removal projects abc to a triangle; 3 if the points are collinear.
unsigned projection_axis(const Point& a, const Point& b, const Point& c) {
  unsigned axis = 0;
  while (axis < 3 && planar_orientation(axis, a, b, c) == 0) ++axis;
  return axis;
}

bool in_triangle(unsigned axis, const Point& p, const Point& a, const Point& b, const Point& c) {
  const auto [low, high] = std::minmax({planar_orientation(axis, a, b, p), planar_orientation(axis, b, c, p),
                                        planar_orientation(axis, c, a, p)});
  return low >= 0 || high <= 0;
}

bool coplanar_segments_meet(unsigned axis, const Point& a, const Point& b, const Point& c, const Point& d) {
  const int ca = planar_orientation(axis, c, d, a), cb = planar_orientation(axis, c, d, b);
  const int ac = planar_orientation(axis, a, b, c), ad = planar_orientation(axis, a, b, d);
  if (ca * cb < 0 && ac * ad < 0) return true;
  return (ac == 0 && between(a, c, b)) || (ad == 0 && between(a, d, b)) || (ca == 0 && between(c, a, d)) ||
         (cb == 0 && between(c, b, d));
}

// The following functions decide exactly whether two simplices, as closed sets, meet. All corners are
// distinct points; triangles have an area.

bool point_on_segment(const Point& p, const Point& a, const Point& b) {
  return collinear(a, b, p) && between(a, p, b);
}

bool point_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  return orientation(a, b, c, p) == 0 && in_triangle(projection_axis(a, b, c), p, a, b, c);
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (orientation(a, b, c, d) != 0) return false;
  unsigned axis = projection_axis(a, b, c);
  if (axis == 3) axis = projection_axis(a, b, d);
  if (axis == 3) return between(a, c, b) || between(a, d, b) || between(c, a, d);
  return coplanar_segments_meet(axis, a, b, c, d);
}

bool segment_meets_triangle(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c) {
  const int from = orientation(a, b, c, p), to = orientation(a, b, c, q);
  if (from * to > 0) return false;
  if (from == 0 && to == 0) {
    const unsigned axis = projection_axis(a, b, c);
    return in_triangle(axis, p, a, b, c) || in_triangle(axis, q, a, b, c) ||
           coplanar_segments_meet(axis, p, q, a, b) || coplanar_segments_meet(axis, p, q, b, c) ||
           coplanar_segments_meet(axis, p, q, c, a);
  }
  const auto [low, high] =
      std::minmax({orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a)});
  return low >= 0 || high <= 0;
}

// Two simplices with their corners, common ones first.
struct Pair {
  Simplex first, second;
  unsigned common = 0;
};

class IntersectionFinder {
 public:
  IntersectionFinder(const ComplexDraft& draft, const Simplices& simplices)
      : draft_(draft), boxes_(simplices.boxes_for_pairs()), simplices_(simplices.list()) {}

  std::vector<std::pair<Index, Index>> pairs(const std::vector<bool>& settled = {}) const {
    std::vector<std::pair<Index, Index>> found;
    boxes_.for_each_pair([&](Index i, Index j) {
      if (!settled.empty() && settled[i] && settled[j]) return;
      const bool triangles = simplices_[i].size == 3 && simplices_[j].size == 3;
      if (triangles ? triangles_illegal(simplices_[i].points, simplices_[j].points) : illegal(ordered(i, j)))
        found.push_back(std::minmax(i, j));
    });
    std::ranges::sort(found);
    return found;
  }

  void run(Faults& faults) const {
    for (const auto& [i, j] : pairs()) report(i, j, faults);
  }

 private:
  const Point& at(Index p) const { return draft_.points[p]; }

  Pair ordered(Index i, Index j) const {
    Pair pair{simplices_[i], simplices_[j], 0};
    if (pair.first.size < pair.second.size) std::swap(pair.first, pair.second);
    for (unsigned a = 0; a < pair.first.size; ++a)
      for (unsigned b = pair.common; b < pair.second.size; ++b) {
        if (pair.first.points[a] != pair.second.points[b]) continue;
        std::swap(pair.first.points[a], pair.first.points[pair.common]);
        std::swap(pair.second.points[b], pair.second.points[pair.common]);
        ++pair.common;
        break;
      }
    return pair;
  }

  // Returns whether the simplices of a pair meet outside their common corners. The first simplex has at least
  // as many corners as the second, which has at most two.
  bool illegal(const Pair& pair) const {
    const auto& f = pair.first.points;
    const auto& s = pair.second.points;
    if (pair.common == pair.second.size) return false;
    if (pair.second.size == 1)
      return pair.first.size == 3 ? point_on_triangle(at(s[0]), at(f[0]), at(f[1]), at(f[2]))
                                  : pair.first.size == 2 && point_on_segment(at(s[0]), at(f[0]), at(f[1]));
    if (pair.first.size == 2)
      return pair.common == 1 ? overlap(f[0], f[1], s[1])
                              : segments_meet(at(f[0]), at(f[1]), at(s[0]), at(s[1]));
    return segment_illegal(pair);
  }

  // Returns whether two triangles meet outside their common corners. Most pairs are two triangles, so they
  // have a function of their own.
  bool triangles_illegal(const Corners& f, const Corners& s) const {
    const auto from = [](const Corners& t, unsigned i) {
      return Corners{t[i % 3], t[(i + 1) % 3], t[(i + 2) % 3]};
    };
    unsigned common = 0, in_f = 0, in_s = 0;  // number of common corners; sums of their positions in f and s
    for (unsigned a = 0; a < 3; ++a)
      for (unsigned b = 0; b < 3; ++b)
        if (f[a] == s[b]) {
          ++common;
          in_f += a;
          in_s += b;
        }
    // The positions 0, 1 and 2 have the sum 3, so the sum of two common corners' positions gives that of the
    // third corner.
    if (common == 2) return folded(from(f, 4 - in_f), from(s, 4 - in_s));
    if (common == 1) return fans_meet(from(f, in_f), from(s, in_s));
    return common == 0 && triangles_meet(f, s);
  }

  // Returns whether the segments ab and ac lie on one ray.
  bool overlap(Index a, Index b, Index c) const {
    return collinear(at(a), at(b), at(c)) && !between(at(b), at(a), at(c));
  }

  bool segment_illegal(const Pair& pair) const {
    const auto& f = pair.first.points;
    const auto& s = pair.second.points;
    if (pair.common == 0) return segment_meets_triangle(at(s[0]), at(s[1]), at(f[0]), at(f[1]), at(f[2]));
    return point_on_triangle(at(s[1]), at(f[0]), at(f[1]), at(f[2])) ||
           segments_meet(at(s[0]), at(s[1]), at(f[1]), at(f[2]));
  }

  // Returns whether two triangles on a common edge overlap.
  bool folded(const Corners& f, const Corners& s) const {
    return predicates::orientation(at(f[0]), at(f[1]), at(f[2]), at(s[2])) == 0 &&
           same_side(at(f[0]), at(f[1]), at(f[2]), at(s[2]));
  }

  // Returns whether two triangles with one common corner meet elsewhere: then the side of one of them that is
  // opposite to that corner meets the other triangle.
  bool fans_meet(const Corners& f, const Corners& s) const {
    if (apart(f, s, 1) || apart(s, f, 1)) return false;
    return segment_meets_triangle(at(f[1]), at(f[2]), at(s[0]), at(s[1]), at(s[2])) ||
           segment_meets_triangle(at(s[1]), at(s[2]), at(f[0]), at(f[1]), at(f[2]));
  }

  bool triangles_meet(const Corners& f, const Corners& s) const {
    if (apart(f, s, 0) || apart(s, f, 0)) return false;
    for (unsigned i = 0; i < 3; ++i) {
      const unsigned j = (i + 1) % 3;
      if (segment_meets_triangle(at(f[i]), at(f[j]), at(s[0]), at(s[1]), at(s[2])) ||
          segment_meets_triangle(at(s[i]), at(s[j]), at(f[0]), at(f[1]), at(f[2])))
        return true;
    }
    return false;
  }

  // Returns whether all corners of s except the common ones lie on one side of the plane of f.
  bool apart(const Corners& f, const Corners& s, unsigned common) const {
    const auto side = [&](Index p) { return predicates::orientation(at(f[0]), at(f[1]), at(f[2]), at(p)); };
    const int first = side(s[common]);
    return first != 0 &&
           std::all_of(s.begin() + common + 1, s.end(), [&](Index p) { return side(p) == first; });
  }

  void report(Index i, Index j, Faults& faults) const {
    if (faults.full(PlcFault::Kind::intersection)) {
      faults.add(PlcFault::Kind::intersection, {}, {}, {});
      return;
    }
    const Pair pair = ordered(i, j);
    const Index touching = touching_corner(pair);
    const Point where = touching != none ? at(touching) : meeting_point(pair);
    std::vector<Index> points(pair.first.corners().begin(), pair.first.corners().end());
    for (unsigned k = pair.common; k < pair.second.size; ++k) points.push_back(pair.second.points[k]);
    const char* how = touching != none ? "touch without a common corner" : "intersect";
    faults.add(PlcFault::Kind::intersection,
               fmt::format("{} {} at {}; cut them along their intersection or move them apart.", name(i, j),
                           how, text(where)),
               std::move(points), where);
  }

  std::string name(Index i, Index j) const {
    const bool one_soup = simplices_[i].size == 3 && simplices_[j].size == 3 &&
                          draft_.origins[i].soup == draft_.origins[j].soup;
    if (one_soup)
      return fmt::format("Facets {} and {} of {}", draft_.origins[i].facet, draft_.origins[j].facet,
                         draft_.soup_names[draft_.origins[i].soup]);
    return fmt::format("The {} and the {}", name(i), name(j));
  }

  std::string name(Index i) const {
    const Simplex& s = simplices_[i];
    if (s.size == 2) return fmt::format("segment {} - {}", text(at(s.points[0])), text(at(s.points[1])));
    if (s.size == 1) return fmt::format("point {}", text(at(s.points[0])));
    return fmt::format("facet {} of {}", draft_.origins[i].facet, draft_.soup_names[draft_.origins[i].soup]);
  }

  // Returns a corner that lies on the other simplex and is not common to both; none if there is none.
  Index touching_corner(const Pair& pair) const {
    for (unsigned k = pair.common; k < pair.second.size; ++k)
      if (on(pair.second.points[k], pair.first)) return pair.second.points[k];
    for (unsigned k = pair.common; k < pair.first.size; ++k)
      if (on(pair.first.points[k], pair.second)) return pair.first.points[k];
    return none;
  }

  bool on(Index p, const Simplex& s) const {
    if (s.size == 3) return point_on_triangle(at(p), at(s.points[0]), at(s.points[1]), at(s.points[2]));
    return s.size == 2 && point_on_segment(at(p), at(s.points[0]), at(s.points[1]));
  }

  // Returns the meeting point, rounded, for messages.
  Point meeting_point(const Pair& pair) const {
    if (const auto p = piercing_point(pair.first, pair.second, pair.common)) return *p;
    if (const auto p = piercing_point(pair.second, pair.first, pair.common)) return *p;
    Box first, second;
    for (const Index p : pair.first.corners()) first.add(at(p));
    for (const Index p : pair.second.corners()) second.add(at(p));
    Box both;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      both.min[axis] = std::max(first.min[axis], second.min[axis]);
      both.max[axis] = std::min(first.max[axis], second.max[axis]);
    }
    return both.centre();
  }

  // Returns a place where a side of the first simplex pierces the second, if that is a triangle.
  std::optional<Point> piercing_point(const Simplex& first, const Simplex& second, unsigned common) const {
    if (first.size < 2 || second.size < 3) return std::nullopt;
    const auto& s = second.points;
    for (unsigned i = 0; i < first.size; ++i) {
      const unsigned j = (i + 1) % first.size;
      if (common > 0 && (i < common || j < common)) continue;
      const Point &p = at(first.points[i]), &q = at(first.points[j]);
      if (!segment_meets_triangle(p, q, at(s[0]), at(s[1]), at(s[2]))) continue;
      const double from = six_volume(at(s[0]), at(s[1]), at(s[2]), p),
                   to = six_volume(at(s[0]), at(s[1]), at(s[2]), q);
      if (from != to) return p + from / (from - to) * (q - p);
    }
    return std::nullopt;
  }

  const ComplexDraft& draft_;
  const BoxTree& boxes_;
  std::span<const Simplex> simplices_;
};

}  // namespace

std::vector<std::pair<Index, Index>> intersecting_pairs(const ComplexDraft& draft, const Simplices& simplices,
                                                        const std::vector<bool>& settled) {
  return IntersectionFinder(draft, simplices).pairs(settled);
}

void find_intersections(const ComplexDraft& draft, const Simplices& simplices, Faults& faults) {
  IntersectionFinder(draft, simplices).run(faults);
}

}  // namespace collarmesh::facets
