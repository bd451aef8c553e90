// Boundary vertices onto exact geometry, without a CAD library: no guarantee is lost whatever it is.
#include "collarmesh/project_boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collarmesh/geometry.h"
#include "support/meshing.h"
#include "support/plc_shapes.h"
#include "support/shapes.h"

namespace collarmesh::testing {
namespace {

std::optional<Point> on_unit_sphere(unsigned, Index, const Point& p) { return p / norm(p); }

void expect_guarantees(const TetMesh& before, const TetMesh& after, const MeshOptions& options) {
  ASSERT_EQ(before.tets, after.tets);
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const auto& [a, b, c, d] = after.tets[t];
    const TetQuality q = measure(after.points[a], after.points[b], after.points[c], after.points[d]);
    ASSERT_GT(q.volume, 0);
    if (after.tet_collar[t] == 0) {
      ASSERT_LE(q.radius_edge, options.radius_edge);
    } else {
      ASSERT_LE(q.max_dihedral, options.collar_angle);
    }
  }
}

TEST(ProjectBoundary, PutsASpheresVerticesOnTheSphere) {
  Meshed meshed = mesh_of(icosphere(1, 12), with_size(0.3));
  ASSERT_EQ(faults(meshed), "");
  const TetMesh before = meshed.result.mesh;
  TetMesh& mesh = meshed.result.mesh;
  const ProjectReport report = project_boundary(mesh, meshed.plc, on_unit_sphere, {.reach = 0.1});
  expect_guarantees(before, mesh, {});
  std::size_t boundary = 0, off = 0;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    if (mesh.features[p].dimension != 2) {
      EXPECT_EQ(mesh.points[p], before.points[p]);
      continue;
    }
    ++boundary;
    off += std::fabs(norm(mesh.points[p]) - 1) > 1e-12 ? 1 : 0;
  }
  EXPECT_EQ(report.vertices, boundary);
  EXPECT_EQ(report.exceptions.size(), off);
  EXPECT_LT(off, boundary / 20);
  EXPECT_GT(report.largest_move, 0);
}

// Targets at random: most cannot be reached, and every one that is not is told.
TEST(ProjectBoundary, LeavesVerticesThatWouldSpoilTets) {
  for (const auto* name : {"cube", "wedge"}) {
    Meshed meshed = std::string(name) == "cube" ? mesh_of(subdivided_box({0, 0, 0}, {1, 1, 1}, 1), with_size(0.2))
                                                : mesh_of(wedge(20, 1), with_size(0.3));
    ASSERT_EQ(faults(meshed), "");
    const TetMesh before = meshed.result.mesh;
    std::uint32_t state = 1;
    const auto number = [&state] {
      state = state * 1664525U + 1013904223U;
      return static_cast<double>(state) / 4294967296.0 - 0.5;
    };
    std::vector<Point> targets;
    const ExactGeometry anywhere = [&](unsigned, Index, const Point& p) -> std::optional<Point> {
      targets.push_back(p + 0.2 * Point{number(), number(), number()});
      return targets.back();
    };
    const ProjectReport report = project_boundary(meshed.result.mesh, meshed.plc, anywhere, {.reach = 1});
    expect_guarantees(before, meshed.result.mesh, {});
    EXPECT_GT(report.exceptions.size(), 0U) << name;
    std::size_t there = 0, next = 0;
    for (std::size_t p = 0; p < before.points.size(); ++p) {
      const auto dimension = before.features[p].dimension;
      if (dimension != 1 && dimension != 2) continue;
      const Point& target = targets.at(next++);
      const Point& now = meshed.result.mesh.points[p];
      EXPECT_TRUE(now == target || now == before.points[p]);
      there += now == target ? 1 : 0;
    }
    EXPECT_EQ(there + report.exceptions.size(), report.vertices);
  }
}

TEST(ProjectBoundary, LeavesWhatIsOutOfReach) {
  Meshed meshed = mesh_of(subdivided_box({0, 0, 0}, {1, 1, 1}, 1), with_size(0.3));
  const TetMesh before = meshed.result.mesh;
  const ExactGeometry far = [](unsigned, Index, const Point& p) -> std::optional<Point> {
    return p + Point{0.05, 0, 0};
  };
  const ProjectReport report = project_boundary(meshed.result.mesh, meshed.plc, far);
  EXPECT_EQ(before.points, meshed.result.mesh.points);
  EXPECT_EQ(report.exceptions.size(), report.vertices);
  EXPECT_NEAR(report.largest_distance, 0.05, 1e-12);
}

}  // namespace
}  // namespace collarmesh::testing
