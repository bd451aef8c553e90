#include "io/one_polygon.h"

#include <fmt/format.h>

#include "collarmesh/error.h"

namespace collarmesh::io {

std::span<const Index> one_polygon(const std::string& path, const PolygonSoup& soup, Index facet) {
  const auto [first, last] = soup.facet_polygons(facet);
  if (last - first != 1 || soup.polygon(first).size() < 3)
    throw WriteError(fmt::format(
        "{}: facet {} has holes or several polygons, which the format has no place for; write a .poly", path,
        facet));
  return soup.polygon(first);
}

}  // namespace collarmesh::io
