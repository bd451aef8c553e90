// Sheets that face each other across a narrow gap: the cost of a gap grows with the length of its rim, not
// with its area divided by its width squared.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::facing_sheets_test {
namespace {

using namespace collarmesh::testing;

// A block of volume 12 minus its slot, which is 2 deep, 3 long and open on three sides.
PolygonSoup slotted_block(double width) {
  const double w = width / 2;
  const std::array<Point, 8> outline{
      {{-1, 0, 0}, {1, 0, 0}, {1, 3, 0}, {w, 3, 0}, {w, 1, 0}, {-w, 1, 0}, {-w, 3, 0}, {-1, 3, 0}}};
  return extrusion(outline, 2);
}
double volume_of_slotted_block(double width) { return 12 - width * 2 * 2; }

Meshed meshed_at_size(const PolygonSoup& soup, double size, double feature_angle, std::uint64_t seed = 0) {
  MeshOptions options = with_size(size);
  options.seed = seed;
  return mesh_of({soup}, options, feature_angle);
}

std::size_t vertices_in(const Meshed& meshed) { return meshed.result.statistics.vertices_inserted; }

TEST(FacingSheets, KeepEveryGuaranteeAcrossSlots) {
  for (const double width : {0.2, 0.05, 0.01, 0.002})
    for (const double degrees : {0.0, 27.0})
      for (const std::uint64_t seed : {0U, 1U}) {
        SCOPED_TRACE(::testing::Message() << width << " turned by " << degrees << " seed " << seed);
        const Meshed meshed = meshed_at_size(rotated(slotted_block(width), {1, 2, 3}, degrees), 0.5, 0, seed);
        EXPECT_EQ(faults(meshed), "");
        EXPECT_LE(meshed.report.max_radius_edge, 2);
        EXPECT_NEAR(meshed.report.region_volumes[1], volume_of_slotted_block(width), 1e-7);
      }
}

TEST(FacingSheets, CostsOfASlotGrowAsItsRim) {
  const auto vertices = [](double width) {
    return vertices_in(meshed_at_size(slotted_block(width), 0.5, 0));
  };
  const auto wide = static_cast<double>(vertices(0.02)), narrow = static_cast<double>(vertices(0.005));
  EXPECT_LT(narrow, 6 * wide);  // if proportional to the area, the cost would be 16 times as large
}

TEST(FacingSheets, CurvedOnesDoNotMakeEachOtherFiner) {
  // The void between two balls: the smaller one lies in the cavity of the larger one.
  for (const double gap : {0.02, 0.005}) {
    SCOPED_TRACE(gap);
    const PolygonSoup soup =
        joined(joined(icosphere(1.5, 12), inverted(icosphere(1, 12))), icosphere(1 - gap, 12));
    const Meshed meshed = meshed_at_size(soup, 0.3, 40);
    EXPECT_EQ(faults(meshed), "");
    expect_count(fmt::format("facing sheets/balls {} apart", gap), vertices_in(meshed));
  }
}

}  // namespace
}  // namespace collarmesh::facing_sheets_test
