// The same input gives the same mesh; moved, scaled, turned or shuffled input gives an equally good mesh.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshing.h"
#include "support/shapes.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::refinement_invariance_test {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

struct Shape {
  std::string name;
  PolygonSoup soup;
  double size;
  double feature_angle;
};

std::vector<Shape> shapes() {
  using namespace testing;
  return {{"box", box(), 0.25, 0},
          {"L", l_shape(), 0.4, 0},
          {"plate", plate_with_hole(1, 16), 0.8, 0},
          {"two boxes", two_boxes(), 0.3, 0},
          {"dangling facet", box_with_dangling_facet(), 0.3, 0},
          {"sphere", icosphere(1, 8), 0.4, 30}};
}

TEST(RefinementInvariance, SameInputAndSeedSameMesh) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const Meshed first = mesh_of(shape.soup, with_size(shape.size), shape.feature_angle);
    const Meshed second = mesh_of(shape.soup, with_size(shape.size), shape.feature_angle);
    EXPECT_EQ(faults(first), "");
    testing::expect_same(first.result.mesh, second.result.mesh);
  }
}

TEST(RefinementInvariance, OtherSeedOtherMesh) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    MeshOptions options = with_size(shape.size);
    const Meshed first = mesh_of(shape.soup, options, shape.feature_angle);
    options.seed = 12345;
    const Meshed second = mesh_of(shape.soup, options, shape.feature_angle);
    EXPECT_EQ(faults(second), "");
    EXPECT_NE(first.result.mesh.points, second.result.mesh.points);
  }
}

// Expects a right mesh, with scaled volumes, of a shape that was mapped and scaled; the size is scaled, too.
// Rounding moves the surface by an ulp of its coordinates and changes the volume accordingly.
void expect_as_good(const Shape& shape, const PolygonSoup& mapped, double scale) {
  const Meshed meshed = mesh_of(mapped, with_size(shape.size * scale), shape.feature_angle);
  EXPECT_EQ(faults(meshed), "");
  if (shape.feature_angle > 0) return;
  const Meshed original = mesh_of(shape.soup, with_size(10), shape.feature_angle);
  ASSERT_EQ(meshed.report.region_volumes.size(), original.report.region_volumes.size());
  const Box& bounds = meshed.plc.bounds;
  const double relative = 1e-12 + 1e-15 * (norm(bounds.min) + norm(bounds.max)) / bounds.diagonal();
  for (std::size_t r = 1; r < original.plc.regions.size(); ++r) {
    const double expected = original.plc.regions[r].volume * scale * scale * scale;
    EXPECT_NEAR(meshed.report.region_volumes[r], expected, 10 * relative * expected) << "region " << r;
  }
}

TEST(RefinementInvariance, FarFromTheOrigin) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const double diagonal = build_plc({&shape.soup, 1}).bounds.diagonal();
    expect_as_good(shape, testing::translated(shape.soup, 1e6 * diagonal * Vector{1, -1, 0.5}), 1);
  }
}

TEST(RefinementInvariance, TinyAndHuge) {
  for (const Shape& shape : shapes())
    for (const double scale : {1e-6, 1e6}) {
      SCOPED_TRACE(shape.name + " times " + std::to_string(scale));
      expect_as_good(shape, testing::scaled(shape.soup, scale), scale);
    }
}

TEST(RefinementInvariance, Turned) {
  for (const Shape& shape : shapes())
    for (const double degrees : {17.0, 45.0, 200.0}) {
      SCOPED_TRACE(shape.name + " by " + std::to_string(degrees));
      expect_as_good(shape, testing::rotated(shape.soup, {1, 2, -0.7}, degrees), 1);
    }
}

TEST(RefinementInvariance, Permuted) {
  for (const Shape& shape : shapes())
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(shape.name);
      expect_as_good(shape, testing::permuted(shape.soup, seed), 1);
    }
}

}  // namespace
}  // namespace collarmesh::refinement_invariance_test
