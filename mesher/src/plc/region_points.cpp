#include <algorithm>
#include <optional>
#include <vector>

#include "collarmesh/merge_soups.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/shells.h"
#include "facets/simplices.h"

namespace collarmesh {

namespace {

using namespace facets;

class PointPlacer {
 public:
  explicit PointPlacer(const Plc& plc)
      : plc_(plc),
        draft_(draft_of(plc)),
        edges_(draft_.triangles, draft_.points.size()),
        shells_(find_shells(draft_, edges_)),
        simplices_(draft_, edges_),
        caster_(draft_, simplices_.boxes()) {}

  Index run(PolygonSoup& soup) {
    find_largest_sides();
    Index missing = 0;
    std::vector<bool> done(plc_.regions.size(), false);
    // A region may have several shells; begin with the one that has the largest triangle.
    for (const Index side : order_of_sides()) {
      const Index region = region_of(side);
      if (region == 0 && encloses_void(side)) {
        if (const auto point = point_in(side))
          soup.hole_points.push_back(*point);
        else
          ++missing;
      } else if (region != 0 && !done[region]) {
        const auto point = point_in(side);
        if (!point) continue;
        done[region] = true;
        const Plc::Region& r = plc_.regions[region];
        soup.region_points.push_back({*point, r.tag, r.size});
      }
    }
    missing += static_cast<Index>(std::count(done.begin() + (done.empty() ? 0 : 1), done.end(), false));
    return missing;
  }

 private:
  static ComplexDraft draft_of(const Plc& plc) {
    ComplexDraft draft;
    draft.points = plc.points;
    draft.bounds = plc.bounds;
    for (const Plc::Triangle& t : plc.triangles) draft.add_triangle(t.points, {});
    return draft;
  }

  Index region_of(Index side) const { return plc_.patches[plc_.triangles[side / 2].patch].regions[side % 2]; }

  double area(Index triangle) const {
    const Point& a = draft_.corner(triangle, 0);
    return squared_norm(cross(draft_.corner(triangle, 1) - a, draft_.corner(triangle, 2) - a));
  }

  /// Finds for each shell the side of its largest triangle, and six times the signed volume that the shell
  /// encloses: positive if the shell's space is inside.
  void find_largest_sides() {
    const auto count = static_cast<Index>(2 * draft_.triangles.size());
    largest_.assign(count, none);
    volume_.assign(count, 0);
    const Point centre = draft_.bounds.centre();
    for (Index side = 0; side < count; ++side) {
      const Index shell = shells_.find(side);
      Index& best = largest_[shell];
      if (best == none || area(side / 2) > area(best / 2)) best = side;
      const Index t = side / 2;
      const double v = six_volume(draft_.corner(t, 0), draft_.corner(t, 1), draft_.corner(t, 2), centre);
      volume_[shell] += side % 2 == 0 ? -v : v;
    }
  }

  std::vector<Index> order_of_sides() const {
    std::vector<Index> sides;
    for (const Index side : largest_)
      if (side != none) sides.push_back(side);
    std::ranges::sort(sides, {}, [this](Index side) { return std::pair(-area(side / 2), side); });
    return sides;
  }

  bool encloses_void(Index side) { return volume_[shells_.find(side)] > 0; }

  /// Casts lines from places on the triangle of this side into the region, each up to the next triangle.
  /// Returns the middle of the longest line; nothing if all lines fail.
  std::optional<Point> point_in(Index side) const {
    constexpr std::size_t attempts = 12;
    const Index t = side / 2;
    const Point &a = draft_.corner(t, 0), &b = draft_.corner(t, 1), &c = draft_.corner(t, 2);
    const Vector normal = cross(b - a, c - a);
    const double reach = 2 * draft_.bounds.diagonal();
    std::optional<Point> best;
    double longest = 0;
    for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
      const Vector w = generic_direction(attempt + 7);
      const double wa = 1 + 0.5 * w.x, wb = 1 + 0.5 * w.y, wc = 1 + 0.5 * w.z;
      const Point at = (wa * a + wb * b + wc * c) / (wa + wb + wc);
      Vector direction = normal / norm(normal) + 0.3 * generic_direction(attempt);
      if (side % 2 == 0) direction = -1.0 * direction;
      const auto crossings = caster_.cast(at - reach * direction, at + reach * direction);
      if (!crossings) continue;
      const auto here =
          std::ranges::find_if(*crossings, [t](const auto& crossing) { return crossing.triangle == t; });
      if (here == crossings->end() || here + 1 == crossings->end()) continue;
      const Point p = crossing_point((here + 1)->triangle, at, direction);
      if (distance(at, p) <= longest) continue;
      longest = distance(at, p);
      best = 0.5 * (at + p);
    }
    return best;
  }

  Point crossing_point(Index triangle, const Point& at, const Vector& direction) const {
    const Point& a = draft_.corner(triangle, 0);
    const Vector normal = cross(draft_.corner(triangle, 1) - a, draft_.corner(triangle, 2) - a);
    return at + dot(normal, a - at) / dot(normal, direction) * direction;
  }

  const Plc& plc_;
  ComplexDraft draft_;
  EdgeTable edges_;
  DisjointSets shells_;
  Simplices simplices_;
  LineCaster caster_;
  std::vector<Index> largest_;  // by shell
  std::vector<double> volume_;
};

}  // namespace

Index place_region_points(const Plc& plc, PolygonSoup& soup) {
  soup.region_points.clear();
  soup.hole_points.clear();
  if (plc.triangles.empty()) return 0;
  return PointPlacer(plc).run(soup);
}

}  // namespace collarmesh
