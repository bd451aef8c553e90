#include "files/faces_at_faults.h"

#include <algorithm>

#include "common/distances.h"

namespace collarmesh::files {

namespace {

// A facet within this distance of a fault's place, relative to the diagonal of all soups, is at the fault.
constexpr double nearby = 1e-6;

double diagonal_of(std::span<const PolygonSoup> soups) {
  Box box;
  for (const PolygonSoup& soup : soups)
    for (const Point& p : soup.points) box.add(p);
  return box.diagonal();
}

/// Returns whether the squared distance of a point from a polygon is at most `squared_reach`. Precondition:
/// the polygon is convex or nearly so.
bool is_near(const Point& p, const PolygonSoup& soup, std::span<const Index> polygon, double squared_reach) {
  const auto& at = soup.points;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    if (squared_distance_to_triangle(p, at[polygon[0]], at[polygon[i - 1]], at[polygon[i]]) <= squared_reach)
      return true;
  return false;
}

}  // namespace

std::set<SoupFace> faces_at(std::span<const PlcFault> faults, std::span<const PolygonSoup> soups) {
  const double reach = nearby * diagonal_of(soups), squared_reach = reach * reach;
  std::set<SoupFace> faces;
  for (Index s = 0; s < soups.size(); ++s)
    for (Index facet = 0; facet < soups[s].facet_count(); ++facet) {
      const auto [first, last] = soups[s].facet_polygons(facet);
      for (Index polygon = first; polygon < last; ++polygon) {
        const auto corners = soups[s].polygon(polygon);
        Box around;
        for (const Index corner : corners) around.add(soups[s].points[corner]);
        if (std::ranges::any_of(faults, [&](const PlcFault& fault) {
              return squared_distance_to_box(fault.where, around) <= squared_reach &&
                     is_near(fault.where, soups[s], corners, squared_reach);
            }))
          faces.emplace(s, soups[s].facet_tag(facet));
      }
    }
  return faces;
}

}  // namespace collarmesh::files
