#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::testing {

/// Adds the triangles of a tube. The soup's points are its sections of `around` points each, one after the
/// other. `closed`: the last section is joined to the first one.
inline void add_tube(PolygonSoup& soup, Index around, bool closed) {
  const auto sections = static_cast<Index>(soup.points.size() / around);
  for (Index i = 0; i + (closed ? 0 : 1) < sections; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around, b = (i + 1) % sections * around, n = (j + 1) % around;
      soup.add_facet(std::vector<Index>{a + j, b + j, b + n});
      soup.add_facet(std::vector<Index>{a + j, b + n, a + n});
    }
}

/// Returns a ring of round section in the plane z = 0.
inline PolygonSoup wire_ring(double radius, double wire, Index around, Index along) {
  PolygonSoup soup;
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * i / along, b = 2 * std::numbers::pi * j / around,
                   r = radius + wire * std::cos(b);
      soup.points.push_back({r * std::cos(a), r * std::sin(a), wire * std::sin(b)});
    }
  add_tube(soup, around, true);
  return soup;
}

}  // namespace collarmesh::testing
