// Parts that a coarser repair may not lose.
#include "pipeline/lost_parts.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/shapes.h"

namespace collarmesh::lost_parts_test {
namespace {

using testing::box;

Plc complex_of(const std::vector<PolygonSoup>& soups) { return build_plc(soups); }

RepairReport of_tolerance(double tolerance) {
  RepairReport report;
  report.tolerance = tolerance;
  return report;
}

TEST(LostParts, BodiesAreCounted) {
  const PolygonSoup block = box(), beside = box({2, 0, 0}, {3, 1, 1});
  const Plc two = complex_of({block, beside}), one = complex_of({block});
  EXPECT_EQ(lost_parts(two, {}, two, of_tolerance(0.01)), "");
  EXPECT_NE(lost_parts(two, {}, one, of_tolerance(0.01)), "");
  EXPECT_EQ(lost_parts(one, {}, two, of_tolerance(0.01)), "");
  // Both boxes as one: no body may become part of another one.
  EXPECT_NE(lost_parts(two, {}, complex_of({box({0, 0, 0}, {2, 1, 1})}), of_tolerance(0.01)), "");
}

TEST(LostParts, SmallOnesMayGoWhereTheyAreThin) {
  const Plc one = complex_of({box()});
  const Plc with_flake = complex_of({box(), box({2, 0, 0}, {2.5, 0.5, 1e-3})});
  EXPECT_EQ(lost_parts(with_flake, {}, one, of_tolerance(2e-3)), "");
  EXPECT_NE(lost_parts(with_flake, {}, one, of_tolerance(5e-4)), "");
  const Plc with_plate = complex_of({box(), box({2, 0, 0}, {5, 3, 1e-3})});
  EXPECT_NE(lost_parts(with_plate, {}, one, of_tolerance(2e-3)), "") << "a plate of 0.9% of the volume";
}

TEST(LostParts, VolumesStay) {
  const Plc one = complex_of({box()});
  EXPECT_EQ(lost_parts(one, {}, complex_of({box({0, 0, 0}, {1, 1, 0.985})}), of_tolerance(0.05)), "");
  EXPECT_NE(lost_parts(one, {}, complex_of({box({0, 0, 0}, {1, 1, 0.97})}), of_tolerance(0.05)), "");
}

TEST(LostParts, TagsAndNamesStay) {
  const PolygonSoup block = box();
  Plc one = complex_of({block});
  RepairReport finer = of_tolerance(1e-5), coarser = of_tolerance(1e-3);
  coarser.lost_tags = {3};  // tags that are only numbers of CAD faces
  EXPECT_EQ(lost_parts(one, finer, one, coarser), "");
  coarser.lost_groups = {3};
  EXPECT_NE(lost_parts(one, finer, one, coarser), "");
  finer.lost_groups = {3};
  EXPECT_EQ(lost_parts(one, finer, one, coarser), "") << "it was lost before";
  coarser.lost_regions = {7};
  EXPECT_NE(lost_parts(one, finer, one, coarser), "");
  Plc named = one, without = one;
  const Tag tag = named.patches[0].tag;
  named.names.set(2, tag, "inlet");
  EXPECT_EQ(lost_parts(named, {}, named, {}), "");
  for (Plc::Patch& patch : without.patches)
    if (patch.tag == tag) patch.tag = 1000;
  EXPECT_NE(lost_parts(named, {}, without, {}).find("inlet"), std::string::npos);
}

}  // namespace
}  // namespace collarmesh::lost_parts_test
