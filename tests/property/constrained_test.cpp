// Tetrahedra with the facets and segments of a complex, compared by brute force over their sides, and meshes
// that begin with them.
#include "constrained/constrained_tetrahedra.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "delaunay/predicates.h"
#include "support/acute_shapes.h"
#include "support/expected_counts.h"
#include "support/shapes.h"

namespace collarmesh::constrained_test {
namespace {

using namespace testing;
using namespace testing::acute;

double area(const Point& a, const Point& b, const Point& c) { return 0.5 * norm(cross(b - a, c - a)); }

void expect_near(double made, double given, const std::string& what) {
  EXPECT_NEAR(made, given, 1e-9 * std::fabs(given)) << what;
}

/// Expects that every side of a tet is a side of another tet or a face of the mesh, and that faces have one
/// or two tets, as they should.
void expect_conforming(const TetMesh& mesh) {
  std::map<std::array<Index, 3>, unsigned> sides;
  const auto sorted = [](std::array<Index, 3> v) {
    std::sort(v.begin(), v.end());
    return v;
  };
  for (const auto& [a, b, c, d] : mesh.tets) {
    EXPECT_GT(predicates::orientation(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), 0);
    for (const auto& side : {std::array{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}) ++sides[sorted(side)];
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto found = sides.find(sorted(mesh.faces[f]));
    ASSERT_NE(found, sides.end());
    EXPECT_EQ(found->second, mesh.face_regions[f][1] == 0 ? 1U : 2U);
    sides.erase(found);
  }
  for (const auto& [side, count] : sides) EXPECT_EQ(count, 2U);
}

void expect_features_of(const Plc& plc, const TetMesh& mesh) {
  std::vector<double> volumes(plc.regions.size(), 0), areas(plc.patches.size(), 0),
      lengths(plc.curves.size(), 0);
  std::vector<double> given_areas(areas), given_lengths(lengths);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.tet_region[t]] +=
        six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  }
  for (std::size_t r = 1; r < volumes.size(); ++r) expect_near(volumes[r], plc.regions[r].volume, "a region");
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    areas[mesh.face_patch[f]] += area(mesh.points[a], mesh.points[b], mesh.points[c]);
  }
  for (const Plc::Triangle& t : plc.triangles)
    given_areas[t.patch] += area(plc.points[t.points[0]], plc.points[t.points[1]], plc.points[t.points[2]]);
  for (std::size_t p = 0; p < areas.size(); ++p)
    if (plc.patches[p].regions[0] != 0 || plc.patches[p].regions[1] != 0)
      expect_near(areas[p], given_areas[p], "a patch");
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    lengths[mesh.edge_curve[e]] += distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]);
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const auto& points = plc.curves[c].points;
    for (std::size_t i = plc.curves[c].closed ? 0 : 1; i < points.size(); ++i)
      given_lengths[c] +=
          distance(plc.points[points[i]], plc.points[points[i == 0 ? points.size() - 1 : i - 1]]);
    expect_near(lengths[c], given_lengths[c], "a curve");
  }
}

void expect_constrained(const std::vector<PolygonSoup>& soups, const std::string& name) {
  SCOPED_TRACE(name);
  const Plc plc = build_plc(soups);
  const ConstrainedTetrahedra made = constrained_tetrahedra(plc);
  ASSERT_FALSE(made.mesh.tets.empty());
  expect_conforming(made.mesh);
  expect_features_of(plc, made.mesh);
}

TEST(Constrained, HasTheFeaturesOfPlainShapes) {
  expect_constrained({box()}, "box");
  expect_constrained({box({0, 0, 0}, {1, 1, 1}, 5)}, "box of many squares");
  expect_constrained({l_shape()}, "L");
  expect_constrained({plate_with_hole(0.2, 40)}, "plate with a hole");
  expect_constrained({cylinder(1, 3, 32, 5)}, "cylinder");
  expect_constrained({torus(3, 1, 24, 12)}, "torus");
  expect_constrained({icosphere(1, 6)}, "sphere");
  expect_constrained({two_boxes()}, "two boxes");
  expect_constrained(touching_boxes(), "boxes that touch");
  expect_constrained(nested_boxes(3), "nested boxes");
  expect_constrained({box_with_dangling_facet()}, "facet that ends inside");
  expect_constrained({box_with_skew_lines(12)}, "lines inside");
  expect_constrained({box_with_cavity(0.3)}, "cavity");
}

TEST(Constrained, HasTheFeaturesOfAcuteShapes) {
  for (const double angle : {40., 5., 0.5}) {
    expect_constrained(wedge(angle).soups, "wedge");
    expect_constrained(knife(angle).soups, "knife");
    expect_constrained(facet_ending_inside(angle).soups, "facet");
    expect_constrained(segment_meeting_a_facet(angle).soups, "segment");
  }
  expect_constrained(fan(24).soups, "fan");
  expect_constrained(comb(8, 4).soups, "comb");
  expect_constrained(round_cone(3).soups, "cone");
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    for (const Shape& shape : random_members(seed)) expect_constrained(shape.soups, shape.name);
    expect_constrained(turned(star_prism(9, 0.2), seed).soups, "star");
    expect_constrained({random_prism(seed)}, "prism");
    expect_constrained({random_hull(seed, 60)}, "hull");
  }
}

TEST(Constrained, TakesNoMorePointsWhereSheetsAreNearer) {
  for (const double height : {1e-1, 1e-3, 1e-5, 1e-7}) {
    const Plc plc = build_plc(std::vector{box({0, 0, 0}, {1, 1, height}, 8)});
    const ConstrainedTetrahedra made = constrained_tetrahedra(plc);
    expect_conforming(made.mesh);
    EXPECT_LE(made.mesh.tets.size(), 4 * plc.triangles.size()) << height;
  }
}

// Edges of the corpus' needles can only be recovered by removing single faces after edges, and by points
// beside flat tets.
TEST(Constrained, RecoversAllEdgesOfNeedlesInTheCorpus) {
  const char* corpus = std::getenv("COLLARMESH_CORPUS");
  if (corpus == nullptr || *corpus == '\0') GTEST_SKIP() << "COLLARMESH_CORPUS names no folder";
  const Plc plc = build_plc(std::vector{io::read_soup(std::string(corpus) + "/cdt_bracket.off")});
  const ConstrainedTetrahedra made = constrained_tetrahedra(plc);
  ASSERT_FALSE(made.mesh.tets.empty());
  expect_conforming(made.mesh);
  EXPECT_LT(made.added_points, plc.points.size());
}

TEST(Constrained, IsCancelled) {
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_TRUE(
      constrained_tetrahedra(build_plc(std::vector{torus(3, 1, 24, 12)}), execution).mesh.tets.empty());
}

SoupPipelineResult begun_constrained(const std::vector<PolygonSoup>& soups, double size, unsigned order = 1) {
  PipelineOptions options;
  options.start = Start::constrained;
  options.mesh.size = size;
  options.order = order;
  return run_pipeline(soups, options);
}

TEST(ConstrainedStart, KeepsEveryGuaranteeOfPlainShapes) {
  for (const double size : {0.5, 0.15}) {
    for (const auto& soup :
         {box(), l_shape(), plate_with_hole(0.2, 40), two_boxes(), box_with_dangling_facet()}) {
      const SoupPipelineResult made = begun_constrained({soup}, size);
      EXPECT_TRUE(made.guarantees_hold()) << size << " " << made.missed();
    }
    EXPECT_TRUE(begun_constrained({cylinder(0.5, 2, 48)}, size, 2).guarantees_hold());
  }
}

// Not all tets at a pinched vertex are found from it.
TEST(ConstrainedStart, DividesEdgesAtPinchedVertices) {
  for (const auto& soups : {cubes_touching_in_an_edge(10).soups, cubes_touching_in_a_corner().soups,
                            boxes_touching_in_an_edge(), pyramids_tip_to_tip(4, 5).soups})
    for (const double size : {2.0, 0.3}) {
      const SoupPipelineResult made = begun_constrained(soups, size);
      ASSERT_FALSE(made.result.mesh.tets.empty());
      for (const Finding& finding : made.check.findings)
        EXPECT_TRUE(finding.guarantee == "thin_angles" || finding.guarantee == "collar_dihedral")
            << finding.message;
    }
}

TEST(ConstrainedStart, LeavesCurvesOutsideOut) {
  PolygonSoup wire;
  wire.points = {{1, 0, 0}, {2, 0, 0}};
  wire.segments = {{0, 1, 9}};
  const SoupPipelineResult made =
      begun_constrained({box({0, 0, 0}, {1, 1, 1}), box({2, 0, 0}, {3, 1, 1}), wire}, 0.4);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  EXPECT_FALSE(mesh.edges.empty());
  for (const auto& edge : mesh.edges)
    EXPECT_TRUE(std::ranges::any_of(mesh.tets, [&edge](const auto& tet) {
      return std::ranges::find(tet, edge[0]) != tet.end() && std::ranges::find(tet, edge[1]) != tet.end();
    }));
}

/// A plate between two waves, far thinner than the size: refinement takes hundreds of thousands of vertices.
PolygonSoup thin_wave(double height) {
  return transformed(box({0, 0, 0}, {1, 1, 1}, 24), [height](const Point& p) {
    return Point{p.x, p.y, 0.05 * std::sin(4 * p.x) * std::cos(3 * p.y) + height * p.z};
  });
}

TEST(ConstrainedStart, MeshesWhatIsFarThinnerThanTheSize) {
  for (const double height : {0.01, 0.001}) {
    const SoupPipelineResult made = begun_constrained({thin_wave(height)}, 0.1);
    ASSERT_FALSE(made.result.mesh.tets.empty()) << height;
    expect_count(fmt::format("constrained/wave {} high", height), made.result.mesh.tets.size());
    for (const Finding& finding : made.check.findings)  // angles may miss their bounds, nothing else
      EXPECT_TRUE(finding.guarantee == "thin_angles" || finding.guarantee == "collar_dihedral")
          << finding.message;
  }
}

// Refinement makes tens of thousands of vertices there, so it is given up at 15,000.
TEST(ConstrainedStart, IsChosenForThinShells) {
  for (const double thickness : {0.05, 0.002}) {
    const PolygonSoup ball = joined(uv_sphere(6, 12, 24), inverted(uv_sphere(6 - thickness, 12, 24)));
    const SoupPipelineResult made = run_pipeline(std::vector{ball}, PipelineOptions());
    EXPECT_TRUE(made.guarantees_hold()) << made.missed();
    EXPECT_EQ(made.result.statistics.vertices_inserted, 0U) << thickness;
    expect_count(fmt::format("constrained/shell {} thick", thickness), made.result.mesh.tets.size());
  }
}

// Refinement needs few vertices there, while improving constrained tetrahedra would take far longer.
TEST(ConstrainedStart, IsNotForCylindersThatNearlyTouch) {
  const PolygonSoup one = cylinder(3, 10, 72), other = translated(one, {6.01, 0, 0});
  PipelineOptions options;
  options.mesh.size = 1;
  const SoupPipelineResult made = run_pipeline(std::vector{joined(one, other)}, options);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_GT(made.result.statistics.vertices_inserted, 0U);
  expect_count("constrained/nearly touching cylinders", made.result.mesh.tets.size());
}

TEST(ConstrainedStart, StopsWhenProgressSaysSo) {
  PipelineOptions options;
  options.start = Start::constrained;
  options.mesh.size = 0.1;
  for (const std::string_view phase : {"tetrahedralize", "remesh"}) {
    Execution execution;
    execution.progress = [phase](const ProgressReport& report) {
      return report.begins || report.phase != phase;
    };
    const SoupPipelineResult made = run_pipeline(std::vector{torus(1, 0.3, 40, 20)}, options, execution);
    EXPECT_EQ(made.result.status, MeshStatus::cancelled) << phase;
    EXPECT_TRUE(made.result.mesh.tets.empty()) << phase;
  }
}

TEST(ConstrainedStart, IsForMeshesThatAreCoarsened) {
  PipelineOptions options;
  options.start = Start::constrained;
  options.coarsen = false;
  EXPECT_THROW(run_pipeline(std::vector{box()}, options), OptionError);
}

TEST(ConstrainedStart, DoesNotDependOnThreads) {
  PipelineOptions options;
  options.start = Start::constrained;
  options.mesh.size = 0.2;
  std::vector<TetMesh> made;
  for (const unsigned threads : {1U, 2U}) {
    options.mesh.threads = threads;
    made.push_back(run_pipeline(std::vector{torus(1, 0.3, 40, 20)}, options).result.mesh);
    ASSERT_FALSE(made.back().tets.empty());
  }
  EXPECT_EQ(made[0].points, made[1].points);
  EXPECT_EQ(made[0].tets, made[1].tets);
  EXPECT_EQ(made[0].edges, made[1].edges);
}

/// Returns the prism over a polygon in x and z (counterclockwise from x to z), from y = 0 to 10.
PolygonSoup extruded(const std::vector<std::array<double, 2>>& outline) {
  const auto n = static_cast<Index>(outline.size());
  PolygonSoup soup;
  for (const double y : {0., 10.})
    for (const auto& [x, z] : outline) soup.points.push_back({x, y, z});
  std::vector<Index> front, back;
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    soup.add_facet({{i, i + n, next + n, next}});
    front.push_back(i);
    back.push_back(2 * n - 1 - i);
  }
  soup.add_facet(front);
  soup.add_facet(back);
  return soup;
}

PolygonSoup block_with_wedge(double h) {
  return extruded({{0, 0}, {10, 0}, {10, 3}, {16, 3}, {10, 3 + h}, {10, 6}, {0, 6}});
}
PolygonSoup block_with_fin(double h) {
  return extruded({{0, 0}, {10, 0}, {10, 3}, {16, 3}, {16, 3 + h}, {10, 3 + h}, {10, 6}, {0, 6}});
}
PolygonSoup block_with_fold(double h) {
  return extruded({{0, 0}, {10, 0}, {10, 6}, {4, 6}, {6, 6 + h}, {0, 6 + 2 * h}});
}
PolygonSoup block_with_slit(double h) {
  return extruded({{0, 0}, {10, 0}, {10, 3}, {4, 3}, {4, 3 + h}, {10, 3 + h}, {10, 6}, {0, 6}});
}

SoupPipelineResult with_elements_of_1(const PolygonSoup& soup, double feature_size = 0.01) {
  PipelineOptions options;
  options.mesh.size = 1;
  options.repair.feature_size = feature_size;
  return run_pipeline(std::vector{soup}, options);
}

double volume_of(const SoupPipelineResult& made) {
  return std::accumulate(made.check.region_volumes.begin() + 1, made.check.region_volumes.end(), 0.0);
}

// Refinement would make up to hundreds of thousands of vertices there.
TEST(ThinFeatures, CostTheSameHoweverThinTheyAreBelowTheFeatureSize) {
  const std::pair<std::string, PolygonSoup (*)(double)> blocks[] = {{"block with wedge", block_with_wedge},
                                                                    {"block with fin", block_with_fin},
                                                                    {"block with fold", block_with_fold},
                                                                    {"block with slit", block_with_slit}};
  std::size_t inserted = 0;
  for (const auto& [name, make] : blocks) {
    std::size_t most_tets = 0;
    for (const double h : {0.009, 0.001, 0.0002}) {
      SCOPED_TRACE(h);
      const SoupPipelineResult made = with_elements_of_1(make(h));
      EXPECT_TRUE(made.guarantees_hold()) << made.missed();
      EXPECT_NEAR(volume_of(made), 600, 100 * h);
      inserted += made.result.statistics.vertices_inserted;
      most_tets = std::max(most_tets, made.result.mesh.tets.size());
    }
    expect_count("thin features/" + name, most_tets);
  }
  expect_count("thin features/all blocks", inserted);
}

// A closed flake is a body of its own, which must not be overlaid.
TEST(ThinFeatures, AreKeptWhereTheyAreBodies) {
  for (const double h : {0.01, 0.001, 0.0001}) {
    PolygonSoup flake;
    flake.points = {{10.5, 4, 2}, {10.5, 6, 2}, {10.5, 5, 4}, {10.5 + h, 5, 2.7}};
    for (const std::array<Index, 3> f : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
      flake.add_facet(f);
    const SoupPipelineResult made = with_elements_of_1(joined(box({0, 0, 0}, {10, 10, 6}), flake));
    EXPECT_TRUE(made.guarantees_hold()) << h << " " << made.missed();
    ASSERT_EQ(made.check.region_volumes.size(), 3U) << h;
    EXPECT_NEAR(std::min(made.check.region_volumes[1], made.check.region_volumes[2]), 2 * h / 3, 0.05 * h);
    expect_count(fmt::format("thin features/flake of {}", h), made.result.mesh.tets.size());
  }
}

TEST(ThinFeatures, AreKeptWithoutAFeatureSize) {
  const SoupPipelineResult made = with_elements_of_1(block_with_slit(0.005), 0);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_FALSE(made.repair.repaired);
  EXPECT_NEAR(volume_of(made), 600 - 0.3, 1e-6);
}

// Opposite vertices of thin walls must face each other; those of constrained tetrahedra do not.
TEST(ConstrainedStart, GivesThinWallsVerticesThatFaceEachOther) {
  for (const double h : {0.1, 0.01}) {
    const SoupPipelineResult made = begun_constrained({block_with_fold(h)}, 1);
    EXPECT_TRUE(made.guarantees_hold()) << h << " " << made.missed();
    EXPECT_NEAR(volume_of(made), 600 + 80 * h, 1e-6) << h;
  }
}

// At first nothing but the four corners of the two sides face each other.
TEST(Constrained, DividesAThinPlate) {
  PipelineOptions options;
  options.mesh = with_size(1);
  options.start = Start::constrained;
  const PolygonSoup plate = box({0, 0, 0}, {10, 10, 0.1});
  const SoupPipelineResult made = run_pipeline({&plate, 1}, options);
  EXPECT_EQ(made.missed(), "");
  EXPECT_LT(median_edge(made.result.mesh), 1.5);
}

}  // namespace
}  // namespace collarmesh::constrained_test
