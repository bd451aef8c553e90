// The surface distance of a run without a given one.
#include "collarmesh/surface_tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"

namespace collarmesh::testing {
namespace {

constexpr double half_thickness = 0.02;

/// A lens of length and width 1, whose two sides meet in sharp edges.
PolygonSoup lens() {
  constexpr Index steps = 32;
  PolygonSoup soup;
  for (Index i = 0; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps, z = half_thickness * std::sin(std::numbers::pi * x);
    for (const double y : {0.0, 1.0})
      for (const double side : {-1.0, 1.0}) soup.points.push_back({x, y, i % steps == 0 ? 0 : side * z});
  }
  const auto at = [](Index i, Index y, Index upper) { return 4 * i + 2 * y + (i % steps == 0 ? 0 : upper); };
  const auto add = [&](std::vector<Index> facet) {
    facet.erase(std::unique(facet.begin(), facet.end()), facet.end());
    if (facet.front() == facet.back()) facet.pop_back();
    soup.add_facet(facet);
  };
  for (Index i = 0; i < steps; ++i) {
    add({at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1)});
    add({at(i, 0, 0), at(i, 1, 0), at(i + 1, 1, 0), at(i + 1, 0, 0)});
    add({at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1)});
    add({at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, 1, 0)});
  }
  return soup;
}

TEST(SurfaceTolerance, GoesByTheThicknessOfSidesThatMeetInSharpEdges) {
  constexpr double size = 0.5, largest_share = 0.1;
  const PolygonSoup soup = lens();
  const Plc plc = build_plc({&soup, 1});
  const SurfaceTolerance tolerance = default_tolerance(plc, size);
  ASSERT_LT(largest_share * 2 * half_thickness, default_distance(size, plc.bounds.diagonal()));
  std::size_t amid = 0;
  for (Index t = 0; t < plc.triangles.size(); ++t) {
    const auto& [a, b, c] = plc.triangles[t].points;
    if (plc.patches[plc.triangles[t].patch].planar) continue;
    const double x = (plc.points[a].x + plc.points[b].x + plc.points[c].x) / 3;
    // Towards the edges it is not as small as these are thin.
    EXPECT_GT(tolerance.at_triangle(t), 1e-4);
    if (std::fabs(x - 0.5) > 0.2) continue;
    ++amid;
    EXPECT_LE(tolerance.at_triangle(t), largest_share * 2 * half_thickness);
  }
  EXPECT_GT(amid, 0U);
}

}  // namespace
}  // namespace collarmesh::testing
