// A mesh whose regions lost much of their volumes is made again, nearer to their surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "collarmesh/pipeline.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::volumes_kept_test {
namespace {

using namespace testing;

SoupPipelineResult meshed(const PolygonSoup& soup, unsigned order = 1) {
  PipelineOptions options;
  options.mesh = with_size(1);
  options.order = order;
  return run_pipeline({&soup, 1}, options);
}

bool has_note(const SoupPipelineResult& made, const std::string& text) {
  return std::ranges::any_of(made.check.notes,
                             [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

TEST(VolumesKept, ShellsLoseLessThanWarningsTell) {
  constexpr double radius = 5.7735, thickness = 0.2;
  const PolygonSoup shell =
      joined(uv_sphere(radius, 12, 24), inverted(uv_sphere(radius - thickness, 12, 24)));
  const SoupPipelineResult made = meshed(shell);
  EXPECT_EQ(made.missed(), "");
  EXPECT_TRUE(has_note(made, "nearer to smooth surfaces"));
  const double input = made.check.of_input.volumes.at(1);
  EXPECT_NEAR(made.check.of_mesh.volumes.at(1), input, 0.02 * input);
  EXPECT_LT(made.result.mesh.tets.size(), 4000U);
}

TEST(VolumesKept, RodsAreMadeOfRings) {
  for (const unsigned order : {1U, 2U}) {
    const SoupPipelineResult made = meshed(cylinder(0.02, 20, 96), order);
    EXPECT_EQ(made.missed(), "");
    EXPECT_TRUE(has_note(made, "rings"));
    const double input = made.check.of_input.volumes.at(1);
    EXPECT_NEAR(made.check.of_mesh.volumes.at(1), input, (order == 1 ? 0.02 : 0.01) * input);
    EXPECT_LT(made.result.mesh.tets.size(), 12000U);
  }
}

}  // namespace
}  // namespace collarmesh::volumes_kept_test
