// Predicted numbers of tets compared with real meshes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/predict.h"
#include "predict/graded_size.h"
#include "predict/solid_angles.h"
#include "refine/sizing.h"
#include "support/shapes.h"

namespace collarmesh::predict_test {
namespace {

using prediction::GradedSize;
using testing::box;

Plc plc_of(const PolygonSoup& soup) { return build_plc(std::vector{soup}, {}); }

PipelineOptions with_size(double size) {
  PipelineOptions options;
  options.mesh.size = size;
  return options;
}

double predicted(const Plc& plc, const PipelineOptions& options) {
  return predict(plc, options, std::array{0.0}).front().tets;
}

double made(const Plc& plc, const PipelineOptions& options) {
  return static_cast<double>(run_pipeline(plc, options).result.mesh.tets.size());
}

void expect_near(const PolygonSoup& soup, const PipelineOptions& options, double factor = 1.4) {
  const Plc plc = plc_of(soup);
  const double ratio = predicted(plc, options) / made(plc, options);
  EXPECT_GT(ratio, 1 / factor);
  EXPECT_LT(ratio, factor);
}

TEST(Predict, Box) {
  for (const double size : {0.3, 0.15, 0.08}) {
    SCOPED_TRACE(size);
    expect_near(box(), with_size(size));
  }
}

TEST(Predict, SphereWithoutCurves) {
  for (const double size : {0.35, 0.17}) {
    SCOPED_TRACE(size);
    expect_near(testing::icosphere(1, 16), with_size(size), 1.6);  // coarse ones keep their volume
  }
}

TEST(Predict, HoleInAPlate) { expect_near(testing::plate_with_hole(0.5, 48), with_size(0.5)); }

// Edges grow only to a multiple of the wall's width, unless it is narrower than a tenth of the size.
TEST(Predict, ThinPlate) {
  const PolygonSoup plate = box({0, 0, 0}, {10, 10, 0.2});
  for (const double size : {1.0, 4.0}) {
    SCOPED_TRACE(size);
    expect_near(plate, with_size(size));
  }
}

TEST(Predict, LongNeedle) {
  for (const double size : {0.5, 1.0}) {
    SCOPED_TRACE(size);
    expect_near(box({0, 0, 0}, {100, 1, 1}), with_size(size));
  }
}

TEST(Predict, TwoRegions) { expect_near(testing::two_boxes(), with_size(0.15)); }

TEST(Predict, SizesOfFeaturesAndPlaces) {
  const Plc plc = plc_of(box());
  const auto near = [&](const PipelineOptions& options) {
    const double ratio = predicted(plc, options) / made(plc, options);
    EXPECT_GT(ratio, 1 / 1.6);
    EXPECT_LT(ratio, 1.6);
  };
  PipelineOptions fine_side = with_size(0.3);
  fine_side.mesh.patch_size[1] = 0.05;
  near(fine_side);
  PipelineOptions fine_corner = with_size(0.3);
  fine_corner.mesh.size_field = [](const Point& p) { return 0.04 + 0.3 * norm(p); };
  near(fine_corner);
}

TEST(Predict, ScalesWithTheUnit) {
  const double small = predicted(plc_of(box()), with_size(0.1)),
               large = predicted(plc_of(box({0, 0, 0}, {1000, 1000, 1000})), with_size(100));
  EXPECT_NEAR(large / small, 1, 1e-6);
}

TEST(Predict, SizesInTheOrderAskedFor) {
  const Plc plc = plc_of(box());
  std::vector<double> told;
  const auto all = predict(plc, with_size(0.25), std::array{0.1, 0.0, 0.5},
                           [&](const Prediction& made) { told.push_back(made.tets); });
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(told, (std::vector{all[0].tets, all[1].tets, all[2].tets}));
  EXPECT_DOUBLE_EQ(all[0].size, 0.1);
  EXPECT_DOUBLE_EQ(all[1].size, 0.25);
  EXPECT_GT(all[0].tets, all[1].tets);
  EXPECT_GT(all[1].tets, all[2].tets);
  EXPECT_GT(all[0].seconds, all[1].seconds);
  EXPECT_DOUBLE_EQ(predict(plc, {}, std::array{0.0})[0].size, std::sqrt(3) / 20);
}

// However small the size, the work is bounded; a mesh that is n times as fine has n^3 times the tets.
TEST(Predict, VerySmallSizes) {
  const Plc plc = plc_of(box());
  const double fine = predicted(plc, with_size(1e-3)), finer = predicted(plc, with_size(1e-4));
  EXPECT_NEAR(std::log10(finer / fine), 3, 0.1);
}

// The work on the curves of finely faceted shapes is bounded, too, over all of their segments.
TEST(Predict, VerySmallSizesOnManySegments) {
  const Plc plc = plc_of(testing::cylinder(1, 1, 1500));
  const double fine = predicted(plc, with_size(1e-6)), finer = predicted(plc, with_size(1e-7));
  EXPECT_NEAR(std::log10(finer / fine), 3, 0.1);
  const double edge = Sizing::edge_per_size * 1e-6;
  EXPECT_NEAR(fine * std::pow(edge, 3) / (std::numbers::pi * 6 / 0.61), 1, 0.1);  // the density of inner
                                                                                  // vertices decides
}

TEST(Predict, Refuses) {
  const Plc plc = plc_of(box());
  EXPECT_THROW(predict(plc, {}, std::array{-1.0}), OptionError);
  EXPECT_THROW(predict(plc, {}, std::array{double{INFINITY}}), OptionError);
  PipelineOptions options;
  options.mesh.size_min = 0.2;
  EXPECT_THROW(predict(plc, options, std::array{0.1}), OptionError);
  EXPECT_NO_THROW(predict(plc, options, std::array{0.0}));
  options.mesh.size = 0.1;
  EXPECT_THROW(predict(plc, options, std::array{0.0}), OptionError);
  EXPECT_NO_THROW(predict(plc, options, std::array{0.3}));
  options = {};
  options.mesh.patch_size[99] = 1;
  EXPECT_THROW(predict(plc, options, std::array{0.0}), OptionError);
  options = {};
  options.coarsen = false;
  EXPECT_THROW(predict(plc, options, std::array{0.0}), OptionError);
}

TEST(GradedSize, IsTheLeastOfItsSources) {
  std::vector<GradedSize::Source> sources;
  for (int i = 0; i < 50; ++i) {
    const Point p{std::sin(7.0 * i), std::sin(11.0 * i), std::sin(13.0 * i)};
    sources.push_back({{p, p, p}, 0.1 + 0.01 * (i % 7), 0.2 + 0.3 * (i % 3)});
  }
  const GradedSize sizes(sources);
  EXPECT_DOUBLE_EQ(sizes.growth(), 0.8);
  for (int i = 0; i < 50; ++i) {
    const Point p{2 * std::cos(3.0 * i), 2 * std::cos(5.0 * i), 2 * std::cos(17.0 * i)};
    double least = 0.6;
    for (const auto& source : sources)
      least = std::min(least, source.size + source.growth * distance(p, source.corners[0]));
    EXPECT_DOUBLE_EQ(sizes.at(p, 0.6), least);
  }
  EXPECT_DOUBLE_EQ(GradedSize({}).at({0, 0, 0}, 3), 3);
}

TEST(SolidAngles, OfABox) {
  const auto angles = prediction::solid_angles(plc_of(box()));
  for (const double share : angles.of_patch) EXPECT_DOUBLE_EQ(share, 0.5);
  for (const double share : angles.of_curve) EXPECT_NEAR(share, 0.25, 1e-12);
  for (const double share : angles.of_vertex) EXPECT_NEAR(share, 0.125, 1e-12);
}

TEST(SolidAngles, OfAnL) {
  const Plc plc = plc_of(testing::l_shape());
  const auto angles = prediction::solid_angles(plc);
  double curves = 0, vertices = 0;
  for (const double share : angles.of_curve) curves += share;
  for (const double share : angles.of_vertex) vertices += share;
  // One of 18 edges and two of 12 corners are concave.
  EXPECT_NEAR(curves, 17 * 0.25 + 0.75, 1e-12);
  EXPECT_NEAR(vertices, 10 * 0.125 + 2 * 0.375, 1e-12);
}

TEST(SolidAngles, BetweenRegions) {
  const Plc plc = plc_of(testing::two_boxes());
  const auto angles = prediction::solid_angles(plc);
  for (Index p = 0; p < plc.patches.size(); ++p)
    EXPECT_DOUBLE_EQ(angles.of_patch[p],
                     plc.patches[p].regions[0] > 0 && plc.patches[p].regions[1] > 0 ? 1 : 0.5);
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const double z = plc.points[plc.vertices[v].point].z;
    EXPECT_NEAR(angles.of_vertex[v], z > 0.5 && z < 1.5 ? 0.25 : 0.125, 1e-12);
  }
}

}  // namespace
}  // namespace collarmesh::predict_test
