#include "predict/vertex_counts.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "check/region_locator.h"
#include "collarmesh/plc_builder.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::vertex_counts_test {
namespace {

using namespace testing;

TEST(CountTets, StopsWhenThereAreEnough) {
  const Plc plc = build_plc(std::vector{box()});
  const prediction::Shape shape(plc);
  const MeshOptions options = with_size(0.05);
  const double all = prediction::count_tets(shape, options);
  EXPECT_EQ(prediction::count_tets(shape, options, {}, 2 * all), all);
  for (const double share : {0.01, 0.1, 0.5}) {
    const double found = prediction::count_tets(shape, options, {}, share * all);
    EXPECT_GE(found, share * all);
    EXPECT_LT(found, (share + 0.25) * all);
  }
}

TEST(TetCounter, GoesOnWhereItEnded) {
  for (const PolygonSoup& soup :
       {box(), plate_with_hole(0.5, 48), two_boxes(), box({0, 0, 0}, {10, 1, 0.01})}) {
    const Plc plc = build_plc(std::vector{soup});
    const prediction::Shape shape(plc);
    const MeshOptions options = with_size(0.1);
    const double all = prediction::count_tets(shape, options);
    prediction::TetCounter counter(shape, options);
    double before = 0;
    for (const double share : {0.01, 0.02, 0.3, 0.3, 0.9}) {
      const double found = counter.count_up_to(share * all);
      EXPECT_GE(found, share * all);
      EXPECT_GE(found, before);
      before = found;
    }
    EXPECT_EQ(counter.count_up_to(2 * all), all);
    EXPECT_EQ(counter.count_up_to(3 * all), all);
  }
}

TEST(ShapeOfPrediction, RegionsAreThoseOfTheLocator) {
  const std::vector<PolygonSoup> soups{box_with_dangling_facet(), box_with_cavity(0.4), two_boxes(),
                                       cone(1, 3, 64), plate_with_hole(0.5, 96)};
  for (const PolygonSoup& soup : soups) {
    const Plc plc = build_plc(std::vector{soup});
    const prediction::Shape shape(plc);
    const checks::RegionLocator locator(plc);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(-0.1, 1.1);
    const Vector extent = plc.bounds.max - plc.bounds.min;
    std::size_t inside = 0;
    Index hint = none;
    for (unsigned i = 0; i < 2000; ++i) {
      const Point p = plc.bounds.min +
                      Vector{share(random) * extent.x, share(random) * extent.y, share(random) * extent.z};
      const auto [distance, triangle] = shape.nearest(p, hint);
      EXPECT_DOUBLE_EQ(distance, shape.nearest(p).distance);
      hint = triangle;
      if (distance == 0) continue;
      const Index region = locator.region_at(p);
      EXPECT_EQ(shape.region_at(p, triangle), region);
      inside += region != 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 200U);
  }
}

}  // namespace
}  // namespace collarmesh::vertex_counts_test
