// Marking calls `measure` only if a cheaper test is inconclusive.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "collarmesh/tet_mesh.h"
#include "remesh/thin_shape.h"
#include "support/sanitized.h"

namespace collarmesh::mark_thin_tets_test {
namespace {

TEST(MarkThinTets, MarksWhatIsAboveTheBound) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto point = [&] { return Point{normal(random), normal(random), normal(random)}; };
  TetMesh mesh;
  for (int i = 0; i < (testing::sanitized ? 2000 : 20000); ++i) {
    const Point a = point(), b = point(), c = point();
    Point d = point();
    // Tets that get flatter and flatter, some inverted.
    if (i % 2 == 0) {
      const double height = std::pow(10, -(i % 17)) * normal(random);
      d = a + 0.3 * (b - a) + 0.4 * (c - a) + height * cross(b - a, c - a);
    }
    const auto first = static_cast<Index>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), {a, b, c, d});
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    mesh.tet_collar.push_back(i % 10 == 0 ? 1 : 0);
  }
  // Uses bounds that equal the ratios of tets, or are slightly off.
  for (int i = 0; i < (testing::sanitized ? 100 : 300); ++i) {
    const auto measured = [&](std::size_t t) {
      const auto& v = mesh.tets[t];
      return measure(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]).radius_edge;
    };
    const double bound = measured(static_cast<std::size_t>(i)) * (1 + (i % 3 - 1) * 1e-15);
    if (!std::isfinite(bound)) continue;
    remeshing::mark_thin_tets(mesh, bound);
    ASSERT_EQ(mesh.tet_thin.size(), mesh.tets.size());
    for (std::size_t t = 0; t < (i == 0 ? mesh.tets.size() : 300); ++t)
      ASSERT_EQ(mesh.tet_thin[t] != 0, mesh.tet_collar[t] == 0 && measured(t) > bound) << i << ' ' << t;
  }
}

}  // namespace
}  // namespace collarmesh::mark_thin_tets_test
