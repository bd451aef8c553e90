#pragma once

#include <algorithm>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::testing {

/// Returns a cylinder from z = 0 to this height with the tag 1 on its side, 2 on its bottom and 3 on its top.
inline PolygonSoup with_tagged_ends(const PolygonSoup& cylinder, double height) {
  PolygonSoup soup;
  soup.points = cylinder.points;
  for (Index f = 0; f < cylinder.facet_count(); ++f) {
    const auto corners = cylinder.polygon(cylinder.facet_polygons(f)[0]);
    const auto all_at = [&](double z) {
      return std::ranges::all_of(corners, [&](Index v) { return cylinder.points[v].z == z; });
    };
    soup.add_facet(corners, all_at(0) ? 2 : all_at(height) ? 3 : 1);
  }
  return soup;
}

}  // namespace collarmesh::testing
