// Boundary vertices moved onto exact geometry, without a CAD library: no guarantee is lost, whatever the
// geometry.
#include "collarmesh/project_boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "collarmesh/geometry.h"
#include "collarmesh/improve.h"
#include "collarmesh/second_order.h"
#include "support/meshing.h"
#include "support/plc_shapes.h"
#include "support/shapes.h"

namespace collarmesh::testing::project_boundary_test {
namespace {

std::optional<Point> on_unit_sphere(unsigned, Index, const Point& p) { return p / norm(p); }

void expect_guarantees(const TetMesh& before, const TetMesh& after, const MeshOptions& options) {
  ASSERT_EQ(before.tets, after.tets);
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const auto& [a, b, c, d] = after.tets[t];
    const TetQuality q = measure(after.points[a], after.points[b], after.points[c], after.points[d]);
    ASSERT_GT(q.volume, 0);
    if (after.tet_collar[t] == 0) {
      ASSERT_LE(q.radius_edge, options.bounds.radius_edge);
    } else {
      ASSERT_LE(q.max_dihedral, options.bounds.collar_angle);
    }
  }
}

TEST(ProjectBoundary, PutsASpheresVerticesOnTheSphere) {
  Meshed meshed = mesh_of(icosphere(1, 12), with_size(0.3));
  ASSERT_EQ(faults(meshed), "");
  TetMesh& mesh = meshed.result.mesh;
  improve(mesh, meshed.plc, {.bounds = without_thin()});  // removes slivers, whose four corners could all be
                                                          // moved onto the sphere
  const TetMesh before = mesh;
  const ProjectReport report =
      project_boundary(mesh, meshed.plc, on_unit_sphere, {.bounds = without_thin(0.1)});
  expect_guarantees(before, mesh, {});
  std::size_t boundary = 0, inside = 0;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    if (mesh.features[p].dimension == 2) {
      ++boundary;
      EXPECT_NEAR(norm(mesh.points[p]), 1, 1e-12);
    } else if (mesh.points[p] != before.points[p]) {
      EXPECT_EQ(mesh.features[p].dimension, 3);
      ++inside;
    }
  }
  EXPECT_EQ(report.vertices, boundary);
  EXPECT_EQ(report.moved_inside, inside);
  EXPECT_EQ(report.exceptions.size(), 0U);
  EXPECT_GT(report.largest_move, 0);
}

/// Patches and straight curves with waves of this height. Geometry whose nearest point on the flat shape is q
/// belongs above q.
ExactGeometry with_waves(const Plc& plc, double height) {
  return [&plc, height](unsigned dimension, Index feature, const Point& p) -> std::optional<Point> {
    const auto wave = [height](const Point& q) {
      return height * std::sin(17 * q.x + 1) * std::sin(19 * q.y + 2) * std::sin(23 * q.z + 3);
    };
    if (dimension == 2) {
      const Plc::Patch& patch = plc.patches[feature];
      const Point q = p - dot(p - patch.origin, patch.normal) * patch.normal;
      return q + wave(q) * patch.normal;
    }
    const Point &a = plc.points[plc.curves[feature].points.front()],
                &b = plc.points[plc.curves[feature].points.back()];
    const Vector along = (b - a) / distance(a, b);
    const Vector across = cross(along, std::fabs(along.x) < 0.8 ? Vector{1, 0, 0} : Vector{0, 1, 0});
    const Point q = a + dot(p - a, along) * along;
    return q + wave(q) / norm(across) * across;
  };
}

/// Returns a complex none of whose features counts as planar or straight.
Plc without_flat_features(Plc plc) {
  for (Plc::Patch& patch : plc.patches) patch.planar = false;
  for (Plc::Curve& curve : plc.curves) curve.straight = false;
  return plc;
}

// All vertices can reach low waves. They cannot reach high ones, and every vertex that stays off is reported.
TEST(ProjectBoundary, MakesRoomAndLeavesVerticesThatFindNone) {
  for (const auto* name : {"cube", "wedge"})
    for (const double height : {0.02, 1.0}) {
      Meshed meshed = std::string(name) == "cube"
                          ? mesh_of(subdivided_box({0, 0, 0}, {1, 1, 1}, 1), with_size(0.2))
                          : mesh_of(wedge(20, 1), with_size(0.3));
      ASSERT_EQ(faults(meshed), "");
      const TetMesh before = meshed.result.mesh;
      const ExactGeometry waves = with_waves(meshed.plc, height);
      const ProjectReport report = project_boundary(meshed.result.mesh, without_flat_features(meshed.plc),
                                                    waves, {.bounds = without_thin(2)});
      expect_guarantees(before, meshed.result.mesh, {});
      std::set<Index> left;
      for (const auto& exception : report.exceptions) left.insert(exception.point);
      std::size_t vertices = 0;
      for (Index p = 0; p < before.points.size(); ++p) {
        const auto [dimension, feature] = before.features[p];
        const Point& now = meshed.result.mesh.points[p];
        if (dimension != 1 && dimension != 2) {
          EXPECT_TRUE(dimension == 3 || now == before.points[p]);
          continue;
        }
        ++vertices;
        EXPECT_LT(left.count(p) > 0 ? distance(now, before.points[p])
                                    : distance(now, *waves(dimension, feature, now)),
                  1e-9);
      }
      EXPECT_EQ(report.vertices, vertices);
      if (height < 0.1) {
        EXPECT_LE(left.size(), vertices / 50) << name;
      } else {
        EXPECT_GT(left.size(), 0U) << name;
      }
    }
}

TEST(ProjectBoundary, LeavesWhatIsOutOfReach) {
  Meshed meshed = mesh_of(subdivided_box({0, 0, 0}, {1, 1, 1}, 1), with_size(0.3));
  const TetMesh before = meshed.result.mesh;
  const ExactGeometry far = [](unsigned, Index, const Point& p) -> std::optional<Point> {
    return p + Point{0.05, 0, 0};
  };
  const ProjectReport report =
      project_boundary(meshed.result.mesh, meshed.plc, far, {.bounds = without_thin()});
  EXPECT_EQ(before.points, meshed.result.mesh.points);
  EXPECT_EQ(report.exceptions.size(), report.vertices);
  EXPECT_NEAR(report.largest_distance, 0.05, 1e-12);
}

// Exact geometry that is flat only up to the tolerance of its shape, as CAD faces and edges may be. Features
// that are planar or straight in the complex stay so, and vertices that are then off the exact geometry are
// reported.
TEST(ProjectBoundary, KeepsFlatFeaturesFlat) {
  for (const double height : {1e-9, 1e-7, 1e-5}) {
    Meshed meshed = mesh_of(subdivided_box({0, 0, 0}, {1, 1, 1}, 1), with_size(0.2));
    ASSERT_EQ(faults(meshed), "");
    const ExactGeometry waves = with_waves(meshed.plc, height);
    const ProjectReport report =
        project_boundary(meshed.result.mesh, meshed.plc, waves, {.bounds = without_thin()});
    EXPECT_EQ(check(meshed.result.mesh, meshed.plc).findings.size(), 0U) << height;
    std::set<Index> told;
    for (const auto& exception : report.exceptions) {
      EXPECT_GT(exception.distance, 1e-9);
      told.insert(exception.point);
    }
    double largest = 0;
    for (Index p = 0; p < meshed.result.mesh.points.size(); ++p) {
      const auto [dimension, feature] = meshed.result.mesh.features[p];
      if (dimension != 1 && dimension != 2) continue;
      const Point& now = meshed.result.mesh.points[p];
      const double off = distance(now, *waves(dimension, feature, now));
      EXPECT_EQ(told.count(p) > 0, off > 1e-9);
      largest = std::max(largest, off);
    }
    EXPECT_DOUBLE_EQ(report.largest_distance, largest);
    make_second_order(meshed.result.mesh, meshed.plc, {.exact = waves, .bounds = without_thin()});
    EXPECT_EQ(check(meshed.result.mesh, meshed.plc).findings.size(), 0U) << height;
  }
}

// The exact rims leave the planes of the caps.
TEST(ProjectBoundary, KeepsCapsFlatAtCurvedRims) {
  MeshOptions options = with_size(0.3);
  options.bounds.distance = 0.01;
  Meshed meshed = mesh_of(polygonal_cylinder(Index{64}, 1.0, 1.0), options);
  ASSERT_EQ(faults(meshed), "");
  const ExactGeometry exact = [](unsigned, Index, const Point& p) -> std::optional<Point> {
    const double radius = std::hypot(p.x, p.y);
    if (radius < 0.99) return p;
    return Point{p.x / radius, p.y / radius, p.z + 1e-4 * std::sin(3 * std::atan2(p.y, p.x))};
  };
  const ProjectReport report =
      project_boundary(meshed.result.mesh, meshed.plc, exact, {.bounds = without_thin(0.01)});
  EXPECT_EQ(check(meshed.result.mesh, meshed.plc).findings.size(), 0U);
  EXPECT_GT(report.exceptions.size(), 0U);
  std::size_t on_rims = 0;
  for (Index p = 0; p < meshed.result.mesh.points.size(); ++p) {
    const Point& now = meshed.result.mesh.points[p];
    if (meshed.result.mesh.features[p].dimension != 1) continue;
    ++on_rims;
    EXPECT_NEAR(std::hypot(now.x, now.y), 1, 1e-9);
  }
  EXPECT_GT(on_rims, 20U);
}

// Faces sag below their vertices, which may lie below the complex by nearly the allowed distance.
TEST(ProjectBoundary, KeepsFacesWithinTheToleranceOfTheComplex) {
  const double tolerance = 0.025, radius = 1 - 0.7 * tolerance;
  MeshOptions options = with_size(0.3);
  options.bounds.distance = 0.7 * tolerance;
  Meshed meshed = mesh_of(icosphere(1, 12), options);
  ASSERT_EQ(faults(meshed), "");
  const ExactGeometry smaller = [&](unsigned, Index, const Point& p) -> std::optional<Point> {
    return radius * (p / norm(p));
  };
  const ProjectReport report =
      project_boundary(meshed.result.mesh, meshed.plc, smaller, {.bounds = without_thin(tolerance)});
  CheckOptions limits;
  limits.bounds = without_thin(tolerance);
  EXPECT_EQ(check(meshed.result.mesh, meshed.plc, limits).findings.size(), 0U);
  EXPECT_GT(report.exceptions.size(), 0U);
  EXPECT_LT(report.exceptions.size(), report.vertices);
}

// The balls of a collar are placed by distances in the complex; projection must not change them.
TEST(ProjectBoundary, LeavesTheBallsOfCollarsAsTheyAre) {
  Meshed meshed = mesh_of(wedge(20, 1), with_size(0.3));
  ASSERT_EQ(faults(meshed), "");
  const TetMesh before = meshed.result.mesh;
  ASSERT_FALSE(before.collar_balls.empty());
  const Plc smooth = without_flat_features(meshed.plc);
  CheckOptions options;
  options.bounds.distance = 0.02;
  project_boundary(meshed.result.mesh, smooth, with_waves(meshed.plc, 0.01),
                   {.bounds = without_thin(options.bounds.distance)});
  const TetMesh& mesh = meshed.result.mesh;
  std::size_t moved = 0;
  ASSERT_EQ(mesh.collar_balls.size(), before.collar_balls.size());
  for (std::size_t b = 0; b < mesh.collar_balls.size(); ++b) {
    EXPECT_EQ(mesh.collar_balls[b].radius, before.collar_balls[b].radius);
    EXPECT_EQ(mesh.collar_balls[b].centre, before.points[mesh.collar_balls[b].point]);
    if (mesh.points[mesh.collar_balls[b].point] != mesh.collar_balls[b].centre) ++moved;
  }
  EXPECT_GT(moved, 0U);
  EXPECT_EQ(check(mesh, smooth, options).findings.size(), 0U);
}

}  // namespace
}  // namespace collarmesh::testing::project_boundary_test
