// Small and thin regions keep their volume at default options, and the certificate says how much of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh {
namespace {

using testing::with_size;

double enclosed_by(const PolygonSoup& soup) {
  double volume = 0;
  for (Index p = 0; p < soup.polygon_count(); ++p) {
    const auto corners = soup.polygon(p);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      volume += dot(soup.points[corners[0]] - Point{},
                    cross(soup.points[corners[i]] - Point{}, soup.points[corners[i + 1]] - Point{})) /
                6;
  }
  return std::fabs(volume);
}

/// Surfaces within each other, from the outermost.
struct Nested {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
};

std::vector<Nested> nested_shapes() {
  using namespace testing;
  return {{"rod", {cylinder(0.03, 1, 48)}, 0.5},
          {"ball in a box", {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.05, 8)}, 0.4},
          {"thick shell", {icosphere(1, 10), icosphere(0.7, 10)}, 0.5},
          {"thin shell", {icosphere(1, 16), icosphere(0.93, 16)}, 0.4}};
}

class ShapeKept : public ::testing::TestWithParam<unsigned> {};

TEST_P(ShapeKept, EveryRegionHasItsVolume) {
  for (const Nested& shape : nested_shapes()) {
    SCOPED_TRACE(shape.name);
    PipelineOptions options;
    options.mesh = with_size(shape.size);
    options.order = GetParam();
    const SoupPipelineResult made = run_pipeline(shape.soups, options);
    EXPECT_EQ(made.missed(), "");
    std::vector<double> expected{0};
    for (std::size_t i = 0; i < shape.soups.size(); ++i)
      expected.push_back(enclosed_by(shape.soups[i]) -
                         (i + 1 < shape.soups.size() ? enclosed_by(shape.soups[i + 1]) : 0));
    const ShapeMeasures &input = made.check.of_input, &mesh = made.check.of_mesh;
    ASSERT_EQ(mesh.volumes.size(), expected.size());
    std::vector<double> volumes = mesh.volumes, given = input.volumes;
    std::sort(expected.begin(), expected.end());
    std::sort(volumes.begin(), volumes.end());
    std::sort(given.begin(), given.end());
    for (std::size_t r = 1; r < expected.size(); ++r) {
      EXPECT_NEAR(given[r], expected[r], 1e-9 * expected[r]);
      EXPECT_NEAR(volumes[r], expected[r], (GetParam() == 1 ? 0.05 : 0.01) * expected[r]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Order, ShapeKept, ::testing::Values(1U, 2U));

// A prism in place of a rod is a finding, unless the distance that allows it was asked for.
TEST(ShapeKept, AVolumeThatIsLostIsAFinding) {
  const PolygonSoup rod = testing::cylinder(0.1, 1, 64);
  PipelineOptions options;
  options.mesh = with_size(0.5);
  options.mesh.bounds.distance = 0.04;
  const SoupPipelineResult made = run_pipeline({&rod, 1}, options);
  ASSERT_EQ(made.missed(), "");
  const double lost = 1 - made.check.of_mesh.volumes[1] / enclosed_by(rod);
  ASSERT_GT(lost, 0.06);
  EXPECT_EQ(made.check.warnings.size(), 1U);
  CheckOptions judge;
  judge.bounds.tolerance = SurfaceTolerance(0.04);
  const CheckReport report = check(made.result.mesh, made.plc, judge);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].guarantee, "volume_kept");
  EXPECT_TRUE(report.warnings.empty());
}

// Of a coarsely cut ball the curved elements of the first try lose more than they may.
TEST(ShapeKept, TheSecondTryHasASmallerDistance) {
  const std::vector<PolygonSoup> soups{testing::box({-1, -1, -1}, {1, 1, 1}), testing::icosphere(0.02, 2)};
  PipelineOptions options;
  options.mesh = with_size(0.4);
  options.order = 2;
  options.seeds = 1;
  const std::string missed = run_pipeline(soups, options).missed();
  EXPECT_NE(missed.find("volume"), std::string::npos) << missed;
  options.seeds = 2;
  EXPECT_EQ(run_pipeline(soups, options).missed(), "");
}

TEST(ShapeKept, AreasAndLengthsAreThoseOfFacesAndEdges) {
  const PolygonSoup box = testing::box({0, 0, 0}, {1, 2, 3});
  PipelineOptions options;
  options.mesh = with_size(0.7);
  for (const unsigned order : {1U, 2U}) {
    options.order = order;
    const SoupPipelineResult made = run_pipeline({&box, 1}, options);
    ASSERT_EQ(made.missed(), "");
    for (const auto& measures : {made.check.of_input, made.check.of_mesh}) {
      double area = 0, length = 0;
      for (const double a : measures.areas) area += a;
      for (const double l : measures.lengths) length += l;
      EXPECT_NEAR(measures.volumes[1], 6, 1e-12);
      EXPECT_NEAR(area, 22, 1e-11);
      EXPECT_NEAR(length, 24, 1e-11);
    }
  }
}

}  // namespace
}  // namespace collarmesh
