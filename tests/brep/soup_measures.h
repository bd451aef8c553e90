#pragma once

#include <map>
#include <utility>
#include <vector>

#include "collarmesh/polygon_soup.h"

/// Volumes enclosed by soups of triangles.
namespace collarmesh::testing {

/// Returns the volume by the divergence theorem.
inline double volume_of(const PolygonSoup& soup) {
  double volume = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto t = soup.polygon(f);
    volume +=
        dot(soup.points[t[0]] - Point{}, cross(soup.points[t[1]] - Point{}, soup.points[t[2]] - Point{})) / 6;
  }
  return volume;
}

/// Returns the number of sides whose triangles do not cancel: each side should be used once in each
/// direction.
inline std::size_t open_sides(const PolygonSoup& soup) {
  std::map<std::pair<Index, Index>, int> balance;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto t = soup.polygon(f);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  std::size_t open = 0;
  for (const auto& [side, sum] : balance) open += sum != 0 ? 1 : 0;
  return open;
}

/// Returns the volumes by region tag.
inline std::map<Tag, double> volumes_of(const std::vector<PolygonSoup>& soups) {
  std::map<Tag, double> volumes;
  for (const PolygonSoup& soup : soups)
    if (soup.region_tag) volumes[*soup.region_tag] += volume_of(soup);
  return volumes;
}

}  // namespace collarmesh::testing
