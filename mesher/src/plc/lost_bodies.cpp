#include "plc/lost_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "common/disjoint_sets.h"
#include "facets/faults.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

/// A set of facets that are connected by corners.
struct Body {
  Box box;
  Index facets = 0;
};

void unite_equal_points(const std::vector<Point>& points, DisjointSets& sets) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index i) {
    const Point& p = points[i];
    return std::tuple(p.x, p.y, p.z);
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i - 1]] == points[order[i]]) sets.unite(order[i - 1], order[i]);
}

template <class Visit>
void for_each_polygon(const PolygonSoup& soup, const Visit& visit) {
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    for (Index q = first; q < last; ++q) visit(soup.polygon(q));
  }
}

void add_bodies(const PolygonSoup& soup, std::vector<Body>& bodies) {
  DisjointSets sets(soup.points.size());
  unite_equal_points(soup.points, sets);
  for_each_polygon(soup, [&](std::span<const Index> corners) {
    for (const Index corner : corners) sets.unite(corners.front(), corner);
  });
  std::vector<Index> body_of(soup.points.size(), none);
  for_each_polygon(soup, [&](std::span<const Index> corners) {
    if (corners.empty()) return;
    Index& body = body_of[sets.find(corners.front())];
    if (body == none) {
      body = static_cast<Index>(bodies.size());
      bodies.emplace_back();
    }
    ++bodies[body].facets;
    for (const Index corner : corners) bodies[body].box.add(soup.points[corner]);
  });
}

/// A search for triangles by place: tells whether one lies in a box that is enlarged on all sides.
class TrianglesByPlace {
 public:
  explicit TrianglesByPlace(const Plc& plc) : plc_(plc), order_(plc.triangles.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::ranges::sort(order_, {}, [this](Index triangle) { return x(triangle); });
  }

  bool any_in(Box box, double around) const {
    const Vector margin{around, around, around};
    box.min = box.min - margin;
    box.max = box.max + margin;
    auto at = std::ranges::partition_point(order_, [&](Index t) { return x(t) < box.min.x; });
    for (; at != order_.end() && x(*at) <= box.max.x; ++at)
      if (std::all_of(plc_.triangles[*at].points.begin(), plc_.triangles[*at].points.end(),
                      [&](Index p) { return holds(box, plc_.points[p]); }))
        return true;
    return false;
  }

 private:
  double x(Index t) const { return plc_.points[plc_.triangles[t].points[0]].x; }
  static bool holds(const Box& box, const Point& p) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
    return true;
  }

  const Plc& plc_;
  std::vector<Index> order_;
};

}  // namespace

std::vector<Plc::Warning> lost_bodies(std::span<const PolygonSoup> soups, const Plc& plc, double distance) {
  constexpr std::size_t listed = 10;
  constexpr Index smallest_closed = 4;       // number of facets
  constexpr double largest_collapsed = 100;  // multiple of the weld distance: points of one body may have
                                             // merged in a chain
  std::vector<Body> small;
  for (const PolygonSoup& soup : soups) add_bodies(soup, small);
  std::erase_if(small, [&](const Body& body) {
    return body.facets < smallest_closed || body.box.diagonal() == 0 ||
           body.box.diagonal() > largest_collapsed * distance;
  });
  if (small.empty()) return {};
  const TrianglesByPlace triangles(plc);
  std::vector<Plc::Warning> warnings;
  std::size_t more = 0;
  for (const Body& body : small) {
    if (triangles.any_in(body.box, 2 * distance)) continue;
    if (warnings.size() < listed)
      warnings.push_back(
          {fmt::format("The body of {} facets at {}, {:.3g} across, is lost: it is smaller than the "
                       "distance within which points are welded or repaired here, {:.3g}; mesh it by itself, "
                       "or lower --weld and --repair-tolerance.",
                       body.facets, text(body.box.centre()), body.box.diagonal(), distance),
           body.box.centre()});
    else
      ++more;
  }
  if (more > 0) warnings.push_back({fmt::format("{} more bodies are lost in the same way.", more), {}});
  return warnings;
}

LostRegions lost_regions(const Plc& before, const Plc& after, double tolerance) {
  constexpr double most_of_a_volume = 0.02;  // share of a volume that a region may lose or gain
  std::multiset<double> volumes;
  for (std::size_t r = 1; r < after.regions.size(); ++r) volumes.insert(std::fabs(after.regions[r].volume));
  std::vector<double> areas(before.regions.size(), 0);
  std::vector<Point> places(before.regions.size());
  for (const Plc::Triangle& t : before.triangles) {
    const Point &a = before.points[t.points[0]], &b = before.points[t.points[1]],
                &c = before.points[t.points[2]];
    for (const Index region : before.patches[t.patch].regions) {
      areas[region] += 0.5 * norm(cross(b - a, c - a));
      places[region] = a;
    }
  }
  LostRegions lost;
  for (std::size_t r = 1; r < before.regions.size(); ++r) {
    const double volume = std::fabs(before.regions[r].volume);
    const auto found = volumes.lower_bound(volume * (1 - most_of_a_volume));
    if (found != volumes.end() && *found <= volume * (1 + most_of_a_volume)) {
      volumes.erase(found);
    } else if (volume <= tolerance * areas[r]) {
      lost.thin_volume += volume;
      lost.thin.push_back(places[r]);
    } else {
      lost.others.push_back(places[r]);
    }
  }
  return lost;
}

}  // namespace collarmesh::plc
