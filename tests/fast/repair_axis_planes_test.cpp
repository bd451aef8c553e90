// Sheets that nearly coincide come onto one plane.
#include "repair/axis_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "support/repair_drafts.h"
#include "support/shapes.h"

namespace collarmesh::repairing::repair_axis_planes_test {
namespace {

using namespace facets;
using namespace testing::faulty;

// Two boxes with a gap of 1e-6 between them, which differs by noise of 1e-9 from corner to corner.
std::array<PolygonSoup, 2> boxes_nearly_in_contact(std::size_t axis) {
  constexpr double gap = 1e-6, noise = 1e-9;
  Point below{2, 2, 2}, above{0, 0, 0}, end{3, 3, 3};
  below[axis] = 1;
  above[axis] = 1 + gap;
  end[axis] = 2;
  std::array<PolygonSoup, 2> boxes{testing::box({0, 0, 0}, below), testing::box(above, end)};
  for (Index p = 0; p < boxes[1].points.size(); ++p)
    if (boxes[1].points[p][axis] == 1 + gap) boxes[1].points[p][axis] += p * noise;
  return boxes;
}

std::set<double> coordinates_near(const ComplexDraft& draft, std::size_t axis, double place) {
  std::set<double> found;
  for (const Point& p : draft.points)
    if (std::fabs(p[axis] - place) < 0.1) found.insert(p[axis]);
  return found;
}

TEST(AxisPlanes, FacetsThatNearlyCoincideComeOntoThePlaneOfMostOfThem) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ComplexDraft draft = draft_of(boxes_nearly_in_contact(axis));
    const std::vector<Point> before = draft.points;
    const FlattenReport report = flatten_axis_planes(draft, 1e-5);
    EXPECT_EQ(coordinates_near(draft, axis, 1).size(), 1U) << axis;
    EXPECT_EQ(report.moved_points, 4U) << axis;
    double largest = 0;
    for (Index p = 0; p < before.size(); ++p)
      largest = std::max(largest, distance(before[p], draft.points[p]));
    EXPECT_EQ(report.largest_distance, largest) << axis;
    EXPECT_LE(largest, 1e-5) << axis;
  }
}

TEST(AxisPlanes, FacetsFartherApartThanTheToleranceStay) {
  ComplexDraft draft = draft_of(boxes_nearly_in_contact(2));
  const std::vector<Point> before = draft.points;
  const FlattenReport report = flatten_axis_planes(draft, 5e-7);
  EXPECT_EQ(coordinates_near(draft, 2, 1).size(), 2U);  // the noise of the second box is gone
  EXPECT_LE(report.largest_distance, 7e-9);
}

TEST(AxisPlanes, ThinPartsAndGivenVerticesStay) {
  const PolygonSoup thin = testing::box({0, 0, 0}, {1, 1, 1e-6});
  ComplexDraft plate = draft_of(thin);
  EXPECT_EQ(flatten_axis_planes(plate, 1e-5).moved_points, 0U);
  ComplexDraft draft = draft_of(boxes_nearly_in_contact(2));
  for (Index p = 0; p < draft.points.size(); ++p) draft.loose_points.push_back(p);
  EXPECT_EQ(flatten_axis_planes(draft, 1e-5).moved_points, 0U);
}

// A fine dome: its facets near the top are nearly perpendicular to the axis, but not flat.
TEST(AxisPlanes, SlopesStay) {
  ComplexDraft draft = draft_of(testing::icosphere(1, 40));
  EXPECT_EQ(flatten_axis_planes(draft, 1e-3).moved_points, 0U);
}

}  // namespace
}  // namespace collarmesh::repairing::repair_axis_planes_test
