// Complexes that are built again.
#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>

#include <cmath>
#include <string>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "files/complex_input.h"
#include "shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::complex_again_test {
namespace {

using files::ComplexInput;

void add_cube(double from, double to, PolygonSoup& soup) {
  const auto first = static_cast<Index>(soup.points.size());
  for (const double z : {from, to})
    for (const double y : {from, to})
      for (const double x : {from, to}) soup.points.push_back({x, y, z});
  for (const std::vector<Index>& facet : std::vector<std::vector<Index>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    std::vector<Index> corners;
    for (const Index p : facet) corners.push_back(first + p);
    soup.add_facet(corners);
  }
}

/// Returns three cubes that overlap; facets of the second one lie 0.004 below those of the first.
PolygonSoup overlapping_cubes() {
  PolygonSoup soup;
  add_cube(0, 10, soup);
  add_cube(5, 9.996, soup);
  add_cube(6, 16, soup);
  return soup;
}

RepairOptions with_tolerance(double tolerance) {
  RepairOptions options;
  options.tolerance = tolerance;
  return options;
}

void expect_same(const ComplexInput& a, const Plc& of_a, const ComplexInput& b, const Plc& of_b) {
  EXPECT_EQ(of_a.points, of_b.points);
  ASSERT_EQ(of_a.triangles.size(), of_b.triangles.size());
  for (std::size_t t = 0; t < of_a.triangles.size(); ++t)
    EXPECT_EQ(of_a.triangles[t].points, of_b.triangles[t].points);
  EXPECT_EQ(a.repaired().tolerance, b.repaired().tolerance);
  EXPECT_EQ(a.repaired().largest_distance, b.repaired().largest_distance);
  ASSERT_EQ(a.soups().size(), b.soups().size());
  EXPECT_EQ(a.soups()[0].points, b.soups()[0].points);
}

ComplexInput input_of(const PolygonSoup& soup) {
  ComplexInput input{std::vector<std::string>()};
  input.add(soup);
  return input;
}

TEST(ComplexAgain, IsThatOfItsToleranceAfterOthers) {
  ComplexInput again = input_of(overlapping_cubes());
  for (const double tolerance : {1e-5, 1e-3, 1e-5, 1e-3, 1e-4, 2e-4, 3e-4, 1e-5}) {
    ComplexInput fresh = input_of(overlapping_cubes());
    const Plc plc = again.build({}, with_tolerance(tolerance));
    const Plc of_fresh = fresh.build({}, with_tolerance(tolerance));
    expect_same(again, plc, fresh, of_fresh);
    EXPECT_TRUE(again.repaired().repaired);
  }
}

TEST(ComplexAgain, HasSurfacesThatWereAddedSince) {
  ComplexInput input = input_of(overlapping_cubes());
  const Plc before = input.build({}, with_tolerance(1e-5));
  PolygonSoup far;
  add_cube(30, 31, far);
  input.add(far);
  const Plc after = input.build({}, with_tolerance(1e-5));
  EXPECT_EQ(after.regions.size(), before.regions.size() + 1);
}

TEST(ComplexAgain, OfCadSolidsKnowsTheShape) {
  const TemporaryFolder folder;
  const std::string path = folder.file("boxes.brep");
  BRepTools::Write(compound({BRepPrimAPI_MakeBox(10, 10, 10).Shape(),
                             BRepPrimAPI_MakeBox(gp_Pnt(20, 0, 0), 10, 10, 1e-4).Shape()}),
                   path.c_str());
  ComplexInput again({path});
  for (const double tolerance : {1e-5, 1e-3, 1e-5, 1e-3}) {
    const Plc plc = again.build({}, with_tolerance(tolerance));
    const ShapeMeasures exact = again.exact_measures(plc);
    ASSERT_GE(exact.volumes.size(), 2U);
    EXPECT_NEAR(exact.volumes[1], 1000, 1e-6);
    const auto nearest = again.exact_geometry(plc)(2, 0, {5, 5, 5});
    ASSERT_TRUE(nearest.has_value());
  }
}

}  // namespace
}  // namespace collarmesh::testing::complex_again_test
