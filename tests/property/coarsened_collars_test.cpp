// Collars of coarsened meshes: the cells that touch a crease, with no dihedral angle above the bound; and, if
// asked for, the bound on the radius-edge ratio away from narrow places. Shapes are measured by formulas of
// this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "support/acute_shapes.h"
#include "support/shapes.h"

namespace collarmesh::coarsened_collars_test {
namespace {

using namespace collarmesh::testing;

double largest_dihedral(const TetMesh& mesh, const std::array<Index, 4>& tet) {
  double largest = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j) {
      std::array<unsigned, 2> others{};
      unsigned count = 0;
      for (unsigned k = 0; k < 4; ++k)
        if (k != i && k != j) others[count++] = k;
      const Point& a = mesh.points[tet[i]];
      const Vector edge = mesh.points[tet[j]] - a;
      const Vector u = mesh.points[tet[others[0]]] - a, v = mesh.points[tet[others[1]]] - a;
      const Vector p = u - (dot(u, edge) / dot(edge, edge)) * edge,
                   q = v - (dot(v, edge) / dot(edge, edge)) * edge;
      largest = std::max(largest, std::acos(dot(p, q) / (norm(p) * norm(q))) * 180 / std::numbers::pi);
    }
  return largest;
}

// The circumcentre c, relative to the first corner, satisfies dot(c, e) = e^2 / 2 for each edge e there.
double radius_edge(const TetMesh& mesh, const std::array<Index, 4>& tet) {
  const Point& a = mesh.points[tet[0]];
  const Vector u = mesh.points[tet[1]] - a, v = mesh.points[tet[2]] - a, w = mesh.points[tet[3]] - a;
  const Vector centre = (dot(u, u) * cross(v, w) + dot(v, v) * cross(w, u) + dot(w, w) * cross(u, v)) /
                        (2 * dot(u, cross(v, w)));
  double shortest = INFINITY;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j)
      shortest = std::min(shortest, distance(mesh.points[tet[i]], mesh.points[tet[j]]));
  return norm(centre) / shortest;
}

std::vector<bool> points_on_creases(const Plc& plc, const TetMesh& mesh) {
  std::set<Index> vertices, curves;
  for (const Crease& crease : find_creases(plc)) {
    if (crease.vertex != none) vertices.insert(crease.vertex);
    if (crease.curve == none) continue;
    curves.insert(crease.curve);
    for (const Index end : plc.curves[crease.curve].ends) vertices.insert(end);
  }
  std::vector<bool> on_crease;
  for (const auto& [dimension, feature] : mesh.features)
    on_crease.push_back((dimension == 0 && vertices.contains(feature)) ||
                        (dimension == 1 && curves.contains(feature)));
  return on_crease;
}

SoupPipelineResult made(const std::vector<PolygonSoup>& soups, const Bounds& bounds, double size,
                        unsigned order = 1) {
  PipelineOptions options;
  options.complex.feature_angle = 0;
  options.mesh.size = size;
  options.mesh.bounds = bounds;
  options.order = order;
  return run_pipeline(soups, options);
}

// Expects that exactly the cells at creases are marked. Returns their number.
std::size_t expect_collars(const SoupPipelineResult& of, double angle) {
  const TetMesh& mesh = of.result.mesh;
  const std::vector<bool> on_crease = points_on_creases(of.plc, mesh);
  std::size_t cells = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& tet = mesh.tets[t];
    const bool touches = std::any_of(tet.begin(), tet.end(), [&](Index v) { return on_crease[v]; });
    EXPECT_EQ(mesh.tet_collar[t] != 0, touches) << "tet " << t;
    if (!touches) continue;
    ++cells;
    EXPECT_LE(largest_dihedral(mesh, tet), angle * (1 + 1e-9)) << "tet " << t;
    EXPECT_EQ(mesh.tet_thin[t], 0) << "tet " << t;
  }
  EXPECT_EQ(of.check.collar_tets, cells);
  return cells;
}

TEST(CoarsenedCollars, KeepTheAngleThatIsAskedFor) {
  const std::vector<std::pair<std::string, std::vector<PolygonSoup>>> shapes{
      {"wedge of 40 degrees", acute::wedge(40).soups},
      {"wedge of 5 degrees", acute::wedge(5).soups},
      {"fan", acute::fan(8).soups},
      {"star", acute::star_prism(9, 0.4).soups}};
  for (const auto& [name, soups] : shapes)
    for (const double angle : {150.0, 130.0, 110.0}) {
      SCOPED_TRACE(name + ", " + std::to_string(angle));
      Bounds bounds;
      bounds.collar_angle = angle;
      const SoupPipelineResult of = made(soups, bounds, 0.3);
      EXPECT_TRUE(of.guarantees_hold()) << of.missed();
      EXPECT_GT(expect_collars(of, angle), 0U);
    }
}

TEST(CoarsenedCollars, AreThereInSecondOrder) {
  const SoupPipelineResult of = made(acute::wedge(20).soups, {}, 0.3, 2);
  EXPECT_TRUE(of.guarantees_hold()) << of.missed();
  EXPECT_GT(expect_collars(of, 150), 0U);
}

TEST(CoarsenedCollars, AreJudged) {
  const SoupPipelineResult of = made(acute::wedge(20).soups, {}, 0.3);
  const auto kinds = [&of](const TetMesh& mesh, const Bounds& bounds) {
    std::set<std::string> found;
    for (const Finding& finding : check(mesh, of.plc, {.bounds = bounds}).findings)
      found.insert(finding.guarantee);
    return found;
  };
  EXPECT_EQ(kinds(of.result.mesh, {}), std::set<std::string>{});
  Bounds tight;
  tight.collar_angle = of.check.max_collar_dihedral - 1;
  EXPECT_EQ(kinds(of.result.mesh, tight), std::set<std::string>{"collar_dihedral"});
  TetMesh wrong = of.result.mesh;
  *std::find_if(wrong.tet_collar.begin(), wrong.tet_collar.end(), [](auto kind) { return kind != 0; }) = 0;
  EXPECT_EQ(kinds(wrong, {}), std::set<std::string>{"collar_cells"});
  wrong = of.result.mesh;
  *std::find(wrong.tet_collar.begin(), wrong.tet_collar.end(), 0) = 1;
  EXPECT_EQ(kinds(wrong, {}), std::set<std::string>{"collar_cells"});
}

// Without a bound on the ratio, some tets of a box have a ratio above 2.
TEST(CoarsenedCollars, KeepTheRatioThatIsAskedForAwayFromNarrowPlaces) {
  for (const double ratio : {1.5, 2.0, 3.0}) {
    SCOPED_TRACE(ratio);
    Bounds bounds;
    bounds.radius_edge = ratio;
    bounds.thin_in_narrow_places_only = true;
    const SoupPipelineResult of = made({box({0, 0, 0}, {3, 2, 1})}, bounds, 0.25);
    EXPECT_TRUE(of.guarantees_hold()) << of.missed();
    for (const auto& tet : of.result.mesh.tets)
      EXPECT_LE(radius_edge(of.result.mesh, tet), ratio * (1 + 1e-9));
  }
}

// Between the two sides of a plate tets stay thin, so that there are few of them.
TEST(CoarsenedCollars, MayBeThinInNarrowPlaces) {
  Bounds bounds;
  bounds.thin_in_narrow_places_only = true;
  const std::vector<PolygonSoup> plate{box({0, 0, 0}, {100, 100, 1})};
  const SoupPipelineResult of = made(plate, bounds, 10), anywhere = made(plate, {}, 10);
  EXPECT_TRUE(of.guarantees_hold()) << of.missed();
  EXPECT_GT(of.check.thin_tets, 0U);
  EXPECT_LT(of.result.mesh.tets.size(), 1.2 * static_cast<double>(anywhere.result.mesh.tets.size()));
}

// A mesh whose tets may be thin anywhere is distinguished from one whose tets may not.
TEST(CoarsenedCollars, ThinTetsInOtherPlacesAreFound) {
  const SoupPipelineResult of = made(acute::pyramid(7, 10).soups, {}, 0.3);
  ASSERT_GT(of.check.thin_tets, 0U);
  Bounds bounds;
  bounds.thin_in_narrow_places_only = true;
  const CheckReport report = check(of.result.mesh, of.plc, {.bounds = bounds});
  EXPECT_GT(report.findings_total, 0U);
  for (const Finding& finding : report.findings) EXPECT_EQ(finding.guarantee, "radius_edge");
}

}  // namespace
}  // namespace collarmesh::coarsened_collars_test
