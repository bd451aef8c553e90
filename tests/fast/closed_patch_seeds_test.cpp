// Seeds of patches without a border: if a vertex is there already, no seed is put beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "refine/surface_check.h"
#include "support/refinement_parts.h"
#include "support/shapes.h"

namespace collarmesh::closed_patch_seeds_test {
namespace {

struct Seeded : testing::KnownCurves {
  explicit Seeded(const Plc& plc) : KnownCurves(plc) { check.seed_closed_patches(); }

  TriangleQuality triangles{domain, mesh, nodes, surface, sizes, facing_sheets, random, queue};
  SurfaceCheck check{domain, mesh, nodes, collars, collar_cells, surface, triangles, points, chains, outcome};
};

// Refinement may insert a vertex opposite one on the other side of a gap, just where a seed is waiting, up to
// rounding. The seed must take that vertex: a second one would make a tiny edge, at which refinement stops.
TEST(ClosedPatchSeeds, TakeAVertexThatIsThereButForRounding) {
  const PolygonSoup soup = testing::icosphere(1, 4);
  const Plc plc = build_plc({&soup, 1}, {.feature_angle = 60});
  Seeded seeded(plc);
  ASSERT_GT(seeded.points.size(), 0U);
  for (Index seed = 0; seed < seeded.points.size(); ++seed) {
    const UnresolvedPoints::Unresolved point = seeded.points[seed];
    const Point beside{std::nextafter(point.point.x, 2), point.point.y, std::nextafter(point.point.z, 2)};
    const Index vertex = seeded.insert(beside, point.feature);
    EXPECT_TRUE(seeded.mesh.on_patch(vertex, point.feature.index));
    EXPECT_LT(distance(beside, point.point), point.apart);
    EXPECT_LE(point.apart, seeded.domain.floor_at(point.point));
  }
}

}  // namespace
}  // namespace collarmesh::closed_patch_seeds_test
