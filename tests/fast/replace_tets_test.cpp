// Tets that are removed whatever their quality, and curve edges that are divided: meshes stay conforming,
// keep their volume, and every new tet is as good as asked.
#include "remesh/replace_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "collarmesh/curved_tet.h"
#include "collarmesh/second_order.h"
#include "improve/improve_edited.h"
#include "support/meshes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::replace_tets_test {
namespace {

using namespace testing;

using remeshing::EditableMesh;
using remeshing::UnwantedTet;

constexpr double any_ratio = 1000;

template <std::size_t n>
std::array<Index, n> sorted(std::array<Index, n> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

double volume_of(const TetMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    volume += six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  return volume;
}

/// Expects that all tets are oriented, that each triangle belongs to two of them or is a face, and that each
/// face is a triangle of a tet.
void expect_conforming(const TetMesh& mesh) {
  std::map<std::array<Index, 3>, unsigned> sides;
  for (const auto& [a, b, c, d] : mesh.tets) {
    EXPECT_GT(six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), 0);
    for (const auto& side : {std::array{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}) ++sides[sorted(side)];
  }
  std::map<std::array<Index, 3>, unsigned> faces;
  for (const auto& face : mesh.faces) ++faces[sorted(face)];
  std::size_t alone = 0;
  for (const auto& [side, count] : sides) {
    EXPECT_LE(count, 2U);
    alone += count == 1 ? 1 : 0;
    if (count == 1) {
      EXPECT_EQ(faces[side], 1U);
    }
  }
  EXPECT_EQ(alone, mesh.faces.size());
}

std::set<std::array<Index, 4>> corners_of(const TetMesh& mesh) {
  std::set<std::array<Index, 4>> all;
  for (const auto& tet : mesh.tets) all.insert(sorted(tet));
  return all;
}

double least_quality_of(const TetMesh& mesh) {
  double least = 1;
  for (const auto& tet : mesh.tets) {
    remeshing::Corners p;
    for (unsigned i = 0; i < 4; ++i) p[i] = mesh.points[tet[i]];
    least = std::min(least, remeshing::shape_quality(p));
  }
  return least;
}

/// Removes tets of a mesh of the complex. Returns their number.
std::size_t replace(TetMesh& mesh, const Plc& plc, const std::vector<UnwantedTet>& unwanted, double least) {
  EditableMesh edited(mesh, plc, SurfaceTolerance(1e-3));
  const remeshing::SliverRule rule(any_ratio);
  const std::size_t gone = remeshing::replace_tets(edited, unwanted, rule, least);
  edited.store();
  return gone;
}

std::vector<UnwantedTet> every(Index step, const TetMesh& mesh) {
  std::vector<UnwantedTet> unwanted;
  for (Index t = 0; t < mesh.tets.size(); t += step) unwanted.push_back({.tet = t});
  return unwanted;
}

TEST(ReplaceTets, GoneTetsLeaveAConformingMeshOfTheQuality) {
  constexpr double least = 0.15;
  const MeshedComplex box = meshed_box(4);
  ASSERT_GT(least_quality_of(box.mesh), least);
  TetMesh mesh = box.mesh;
  const std::vector<UnwantedTet> unwanted = every(5, mesh);
  const std::size_t gone = replace(mesh, box.plc, unwanted, least);
  const auto left = corners_of(mesh);
  std::size_t absent = 0;
  for (const UnwantedTet& each : unwanted)
    if (!left.contains(sorted(box.mesh.tets[each.tet]))) ++absent;
  EXPECT_EQ(gone, absent);
  EXPECT_GT(2 * gone, unwanted.size());
  EXPECT_NEAR(volume_of(mesh), 1, 1e-12);
  EXPECT_GE(least_quality_of(mesh), least);
  expect_conforming(mesh);
}

TEST(ReplaceTets, AnEdgeThatIsNamedIsDivided) {
  const MeshedComplex box = meshed_box(4);
  std::size_t divided = 0;
  for (Index t = 0; t < box.mesh.tets.size(); t += 37) {
    TetMesh mesh = box.mesh;
    const auto& tet = box.mesh.tets[t];
    const std::array<Index, 2> edge{std::min(tet[0], tet[3]), std::max(tet[0], tet[3])};  // a cube's diagonal
    if (replace(mesh, box.plc, {{.tet = t, .edge = edge}}, 0.15) == 0) continue;
    ++divided;
    EXPECT_EQ(mesh.points.size(), box.mesh.points.size() + 1);
    const Point &a = mesh.points[edge[0]], &b = mesh.points[edge[1]], &p = mesh.points.back();
    EXPECT_LT(norm(cross(b - a, p - a)), 1e-12);
    EXPECT_GT(dot(p - a, b - p), 0);
    expect_conforming(mesh);
  }
  EXPECT_GT(divided, 5U);
}

// No tet can be better than a regular one.
TEST(ReplaceTets, TetsStayWhereTheQualityCannotBeReached) {
  const MeshedComplex box = meshed_box(3);
  TetMesh mesh = box.mesh;
  EXPECT_EQ(replace(mesh, box.plc, every(3, mesh), 0.9999), 0U);
  EXPECT_EQ(mesh.points, box.mesh.points);
  EXPECT_EQ(corners_of(mesh), corners_of(box.mesh));
}

TEST(ReplaceTets, NoVertexComesOntoASmoothPatch) {
  const Meshed meshed = mesh_of(cylinder(0.5, 1, 40, 4), with_size(0.35));
  ASSERT_EQ(faults(meshed), "");
  TetMesh mesh = meshed.result.mesh;
  const std::size_t before = mesh.points.size();
  EXPECT_GT(replace(mesh, meshed.plc, every(2, mesh), 0.05), 0U);
  EXPECT_GT(mesh.points.size(), before);
  for (std::size_t v = before; v < mesh.points.size(); ++v) {
    const auto [dimension, feature] = mesh.features[v];
    EXPECT_TRUE(dimension == 3 || (dimension == 2 && meshed.plc.patches[feature].planar));
  }
  const double surface = 5;  // faces may be others, within the tolerance
  EXPECT_NEAR(volume_of(mesh), volume_of(meshed.result.mesh), 1e-3 * surface);
  expect_conforming(mesh);
}

double length_of_curves(const TetMesh& mesh) {
  double length = 0;
  for (const auto& [a, b] : mesh.edges) length += distance(mesh.points[a], mesh.points[b]);
  return length;
}

TEST(DivideCurves, NewVerticesAreTheMiddlesOfLongCurveEdges) {
  MeshOptions coarse;
  coarse.size = 40;
  coarse.bounds.radius_edge = 20;
  const Meshed meshed = mesh_of(box({0, 0, 0}, {4, 1, 1}), coarse, 0);
  ASSERT_EQ(meshed.result.status, MeshStatus::complete) << meshed.result.message;
  TetMesh mesh = meshed.result.mesh;
  std::vector<Point> middles;
  for (const auto& [a, b] : mesh.edges) middles.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
  const std::size_t before = mesh.points.size();
  Bounds bounds;
  bounds.radius_edge = 1;
  bounds.thin_angle = 30;
  EditableMesh edited(mesh, meshed.plc, SurfaceTolerance(1e-3));
  const std::size_t divided = remeshing::improvement::divide_curves_at_poor_tets(edited, bounds);
  edited.store();
  EXPECT_GT(divided, 0U);
  EXPECT_EQ(mesh.points.size(), before + divided);
  for (std::size_t v = before; v < mesh.points.size(); ++v) {
    EXPECT_EQ(mesh.features[v].dimension, 1);
    EXPECT_TRUE(std::ranges::any_of(
        middles, [&](const Point& middle) { return distance(middle, mesh.points[v]) < 1e-12; }));
  }
  EXPECT_EQ(mesh.edges.size(), meshed.result.mesh.edges.size() + divided);
  EXPECT_NEAR(length_of_curves(mesh), 24, 1e-12);
  EXPECT_NEAR(volume_of(mesh), 4, 1e-12);
  expect_conforming(mesh);
}

TEST(DivideCurves, TetsWithinTheBoundsAreLeft) {
  const MeshedComplex box = meshed_box(2);
  TetMesh mesh = box.mesh;
  EditableMesh edited(mesh, box.plc, SurfaceTolerance(1e-3));
  EXPECT_EQ(remeshing::improvement::divide_curves_at_poor_tets(edited, {}), 0U);
}

// Two edges on a circle have one tangent at their common corner, so a tet with both edges cannot be curved.

std::size_t count_flat(const TetMesh& mesh) {
  const auto on_circle = [&](Index a, Index b) {
    return std::ranges::any_of(mesh.edges, [&](const std::array<Index, 2>& edge) {
      return sorted(edge) == sorted(std::array{a, b});
    });
  };
  return static_cast<std::size_t>(std::ranges::count_if(mesh.tets, [&](const std::array<Index, 4>& tet) {
    return std::ranges::any_of(tet, [&](Index at) {
      return std::ranges::count_if(tet, [&](Index other) { return other != at && on_circle(at, other); }) > 1;
    });
  }));
}

TEST(FlatCorners, TetsWithTwoEdgesOnACircleAreReplacedBeforeTheyAreCurved) {
  const MeshedComplex cylinder = meshed_cylinder_with_ears(8, 8);
  ASSERT_EQ(count_flat(cylinder.mesh), 4U);
  TetMesh mesh = cylinder.mesh, as_given = cylinder.mesh;
  SecondOrderOptions options;
  options.bounds.distance = 0.1;
  const SecondOrderReport report = make_second_order(mesh, cylinder.plc, options);
  EXPECT_EQ(count_flat(mesh), 0U);
  EXPECT_GT(report.more_tets, 0);
  EXPECT_EQ(mesh.tets.size(), cylinder.mesh.tets.size() + static_cast<std::size_t>(report.more_tets));
  EXPECT_EQ(mesh.order(), 2);
  for (Index t = 0; t < mesh.tets.size(); ++t)
    EXPECT_TRUE(jacobian_exceeds(curved_tet(mesh, t), options.least_jacobian));
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Point& middle = mesh.points[mesh.edge_mid_nodes[e]];
    EXPECT_NEAR(std::hypot(middle.x, middle.y), 1, 0.01);
  }
  expect_conforming(mesh);
  options.bounds.thin_angle = 0;  // no tet may be thin, so none is replaced
  const SecondOrderReport without = make_second_order(as_given, cylinder.plc, options);
  EXPECT_EQ(without.more_tets, 0);
  EXPECT_GT(without.straightened.size(), report.straightened.size());
}

}  // namespace
}  // namespace collarmesh::replace_tets_test
