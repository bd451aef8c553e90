#include "facets/weld.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "common/disjoint_sets.h"

namespace collarmesh::facets {

namespace {

// The used points of all soups in one array.
struct UsedPoints {
  std::vector<Point> points;
  std::vector<Tag> tags;
};

bool is_finite(const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Marks a corner as used; adds a fault if there is no such point.
void use(const PolygonSoup& soup, Index point, const char* what, Index number, std::vector<Index>& used,
         Faults& faults) {
  if (point < used.size()) {
    used[point] = 0;
    return;
  }
  faults.add(PlcFault::Kind::bad_point,
             fmt::format("{}: {} {} uses point {}, but there are {} points only; correct the file's indices.",
                         soup.name, what, number, point, used.size()),
             {point}, {});
}

// Returns for each point 0 if it is used, else none.
std::vector<Index> find_used(const PolygonSoup& soup, Faults& faults) {
  std::vector<Index> used(soup.points.size(), is_complex(soup) ? 0 : none);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    for (Index q = first; q < last; ++q)
      for (const Index corner : soup.polygon(q)) use(soup, corner, "facet", f, used, faults);
  }
  for (Index s = 0; s < soup.segments.size(); ++s)
    for (const Index end : {soup.segments[s].a, soup.segments[s].b})
      use(soup, end, "segment", s, used, faults);
  for (Index v = 0; v < soup.vertices.size(); ++v) use(soup, soup.vertices[v], "vertex", v, used, faults);
  return used;
}

UsedPoints collect(std::span<const PolygonSoup> soups, PointMap& map, Faults& faults) {
  UsedPoints all;
  for (const PolygonSoup& soup : soups) {
    map.merged.push_back(find_used(soup, faults));
    for (Index p = 0; p < soup.points.size(); ++p) {
      if (map.merged.back()[p] == none) continue;
      if (!is_finite(soup.points[p]))
        faults.add(PlcFault::Kind::bad_point,
                   fmt::format("{}: point {} is {}, which is not finite; correct its coordinates.", soup.name,
                               p, text(soup.points[p])),
                   {p}, {});
      map.merged.back()[p] = static_cast<Index>(all.points.size());
      all.points.push_back(soup.points[p]);
      all.tags.push_back(soup.point_tags.empty() ? 0 : soup.point_tags[p]);
    }
  }
  return all;
}

// Coordinates must resolve at least this many steps across the input.
constexpr double fewest_steps = 4096;
// If the extent and the coordinates keep these limits, the products of lengths in all decisions are within a
// double's range.
constexpr double smallest_extent = 1e-30, largest_coordinate = 1e30;

void require_range(const Box& box, Faults& faults) {
  if (box.empty()) return;
  double farthest = 0, extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    farthest = std::max({farthest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
    extent = std::max(extent, box.max[axis] - box.min[axis]);
  }
  if (extent > 0 && farthest <= largest_coordinate && extent < fewest_steps * 0x1p-52 * farthest)
    faults.add(
        PlcFault::Kind::bad_point,
        fmt::format("The distance of the input from the origin is {:.2g} times its extent, at {}: in double "
                    "precision, coordinates there are too coarse for a mesh; move it towards the origin.",
                    farthest / extent, text(box.min)),
        {}, box.min);
  const bool large = farthest > largest_coordinate;
  if (!large && (extent >= smallest_extent || extent == 0)) return;
  faults.add(
      PlcFault::Kind::bad_point,
      fmt::format("The input is too {} to compute with: from {} to {}; scale it so that its coordinates lie "
                  "between 1e-30 and 1e30.",
                  large ? "large" : "small", text(box.min), text(box.max)),
      {}, box.min);
}

// Finds equal and close points by a sweep, and unites them. Faces of real parts are hardly ever orthogonal to
// the direction of the sweep, so few points have the same position along it.
DisjointSets find_close(const std::vector<Point>& points, const Box& bounds, double distance_limit) {
  const Vector direction{0.6180339887, 0.5381966011, 0.5731523012};
  const Point centre = bounds.centre();
  const auto count = static_cast<Index>(points.size());
  std::vector<std::pair<double, Index>> order(count);
  for (Index p = 0; p < count; ++p) order[p] = {dot(direction, points[p] - centre), p};
  std::ranges::sort(order, [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const Point &p = points[a.second], &q = points[b.second];
    return std::tie(p.x, p.y, p.z, a.second) < std::tie(q.x, q.y, q.z, b.second);
  });

  DisjointSets sets(count);
  std::vector<std::pair<double, Index>> distinct;
  for (const auto& entry : order) {
    if (!distinct.empty() && points[distinct.back().second] == points[entry.second])
      sets.unite(distinct.back().second, entry.second);
    else
      distinct.push_back(entry);
  }
  if (distance_limit <= 0) return sets;
  const double window = norm(direction) * distance_limit + 1e-15 * bounds.diagonal();
  for (std::size_t i = 0; i < distinct.size(); ++i)
    for (std::size_t j = i + 1; j < distinct.size() && distinct[j].first - distinct[i].first <= window; ++j)
      if (distance(points[distinct[i].second], points[distinct[j].second]) <= distance_limit)
        sets.unite(distinct[i].second, distinct[j].second);
  return sets;
}

}  // namespace

bool is_complex(const PolygonSoup& soup) {
  std::string extension = std::filesystem::path(soup.name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return !soup.region_points.empty() || !soup.hole_points.empty() || extension == ".poly" ||
         extension == ".smesh";
}

PointMap weld_points(std::span<const PolygonSoup> soups, double distance_limit, ComplexDraft& draft,
                     Faults& faults) {
  PointMap map;
  const UsedPoints all = collect(soups, map, faults);
  if (!faults.empty()) return map;
  Box bounds;
  for (const Point& p : all.points) bounds.add(p);
  require_range(bounds, faults);
  if (!faults.empty()) return map;
  DisjointSets sets = find_close(all.points, bounds, distance_limit * bounds.diagonal());

  std::vector<Index> merged(all.points.size());
  for (Index p = 0; p < all.points.size(); ++p) {
    const Index first = sets.find(p);
    if (first == p) {
      merged[p] = static_cast<Index>(draft.points.size());
      draft.points.push_back(all.points[p]);
      draft.point_tags.push_back(all.tags[p]);
      draft.bounds.add(all.points[p]);
    } else {
      merged[p] = merged[first];
      ++draft.cleanup.welded_points;
      draft.largest_deviation = std::max(draft.largest_deviation, distance(all.points[p], all.points[first]));
    }
  }
  for (auto& soup : map.merged)
    for (Index& p : soup)
      if (p != none) p = merged[p];
  return map;
}

}  // namespace collarmesh::facets
