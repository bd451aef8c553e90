// Complexes with creases through `generate`: every family at set parameters and with random members. The
// certificate judges with a radius-edge bound of 2 and dihedral angles of at most 150 degrees in collars;
// planar shapes may lose volume only by rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <set>

#include "support/acute_shapes.h"
#include "support/meshing.h"

namespace collarmesh::collar_test {
namespace {

namespace acute = testing::acute;
using testing::Meshed;

constexpr double size = 0.3;

double volume_of(const Plc& plc) {
  return std::accumulate(plc.regions.begin() + 1, plc.regions.end(), 0.0,
                         [](double sum, const Plc::Region& region) { return sum + region.volume; });
}

double area_of(const Plc& plc) {
  double area = 0;
  for (const auto& t : plc.triangles) {
    const Point &a = plc.points[t.points[0]], &b = plc.points[t.points[1]], &c = plc.points[t.points[2]];
    area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

double shortest_edge(const TetMesh& mesh) {
  double shortest = INFINITY;
  for (const auto& tet : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        shortest = std::min(shortest, distance(mesh.points[tet[i]], mesh.points[tet[j]]));
  return shortest;
}

// The volume of planar shapes must be exact; smooth surfaces move by at most the distance tolerance. Repairs
// of the collar surface must not end at the floor of the refinement, 1e-10 of the diagonal.
void expect_right(const acute::Shape& shape) {
  SCOPED_TRACE(shape.name);
  const Meshed meshed =
      testing::mesh_of(shape.soups, testing::with_near_surface(shape.soups, size), shape.feature_angle);
  EXPECT_EQ(testing::faults(meshed), "");
  EXPECT_GT(shortest_edge(meshed.result.mesh), 1e-8 * meshed.plc.bounds.diagonal());
  const auto& volumes = meshed.report.region_volumes;
  const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  if (shape.feature_angle == 0) {
    EXPECT_NEAR(volume, shape.volume, 1e-11 * shape.volume);
  } else {
    EXPECT_NEAR(volume, volume_of(meshed.plc), area_of(meshed.plc) * 1e-3 * meshed.plc.bounds.diagonal());
  }
}

TEST(Collar, Wedges) {
  for (const double angle : {80.0, 60.0, 40.0, 20.0, 10.0, 5.0, 2.0, 1.0}) expect_right(acute::wedge(angle));
}

TEST(Collar, WedgeHasStarsAndBooks) {
  const acute::Shape wedge = acute::wedge(30);
  const TetMesh mesh = testing::mesh_of(wedge.soups, testing::with_size(size), 0).result.mesh;
  std::array<std::size_t, 3> kinds{};
  for (const std::uint8_t kind : mesh.tet_collar) ++kinds.at(kind);
  EXPECT_GT(kinds[1], 0U);
  EXPECT_GT(kinds[2], 0U);
  EXPECT_GT(kinds[0], kinds[1]);
}

TEST(Collar, CellsBearTheTagOfTheirCrease) {
  PlcOptions options;
  options.feature_angle = 0;
  Plc plc = build_plc(acute::fan(5).soups, options);
  for (Index v = 0; v < plc.vertices.size(); ++v) plc.vertices[v].tag = 1000 + v;
  for (Index c = 0; c < plc.curves.size(); ++c) plc.curves[c].tag = 1 + c;
  const TetMesh mesh = testing::mesh_of(plc, testing::with_size(size)).result.mesh;
  std::vector<Tag> tag_at(mesh.points.size(), 0);  // by point: tag of the crease of the ball centred there
  for (const TetMesh::CollarBall& ball : mesh.collar_balls) {
    const auto [dimension, feature] = mesh.features[ball.point];
    tag_at[ball.point] = dimension == 0 ? plc.vertices[feature].tag : plc.curves[feature].tag;
  }
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    std::set<Tag> tags;
    for (const Index p : mesh.tets[t])
      if (tag_at[p] != 0) tags.insert(tag_at[p]);
    if (mesh.tet_collar[t] == 0) {
      EXPECT_EQ(mesh.tet_crease[t], 0);
    } else if (mesh.tet_collar[t] == 1) {
      EXPECT_EQ(tags, std::set<Tag>{mesh.tet_crease[t]});
    } else {
      EXPECT_LT(mesh.tet_crease[t], 1000);  // an edge's tag, not a corner's
      EXPECT_EQ(tags.count(mesh.tet_crease[t]), 1U);
    }
  }
}

TEST(Collar, SmallWedgesBesideLargeOnes) {
  for (const double small : {1e-2, 1e-4, 1e-6})
    for (const double angle : {70.0, 20.0}) expect_right(acute::wedge_on_a_large_one(angle, small));
}

TEST(Collar, Fans) {
  for (const unsigned k : {3U, 4U, 5U, 6U, 8U, 10U, 12U, 16U, 24U}) expect_right(acute::fan(k));
  for (const unsigned k : {4U, 5U, 9U, 14U}) expect_right(acute::fan(k, k));
}

// The exact centre of a cell between two sheets often lies on a third sheet: it must not be inserted there.
TEST(Collar, CentresOnSheets) {
  for (const std::uint64_t seed : {0U, 1U, 2U}) {
    MeshOptions options = testing::with_size(size);
    options.seed = seed;
    EXPECT_EQ(testing::faults(testing::mesh_of(acute::fan(24).soups, options, 0)), "");
  }
}

TEST(Collar, FansOfManySheets) {
  expect_right(acute::fan(40));
  expect_right(acute::fan(56));
}

TEST(Collar, Sectors) {
  for (const unsigned k : {5U, 6U, 8U, 12U, 20U}) expect_right(acute::sectors(k));
}

TEST(Collar, PyramidsAndNeedles) {
  for (const unsigned k : {3U, 4U, 7U})
    for (const double angle : {60.0, 30.0, 10.0, 5.0, 2.0}) expect_right(acute::pyramid(k, angle));
}

TEST(Collar, StarPrisms) {
  for (const unsigned points : {4U, 5U, 7U, 9U, 12U}) expect_right(acute::star_prism(points, 0.4));
  expect_right(acute::star_prism(9, 0.2));
  expect_right(acute::star_prism(12, 0.7));
}

TEST(Collar, SpikedOctahedra) {
  for (const double height : {0.2, 0.5, 1.0, 2.0}) expect_right(acute::spiked_octahedron(height));
}

TEST(Collar, Knives) {
  for (const double angle : {60.0, 30.0, 10.0, 5.0, 2.0}) expect_right(acute::knife(angle));
  for (const double angle : {40.0, 20.0, 10.0}) expect_right(acute::two_knives(angle, 20));
}

TEST(Collar, SolidsThatTouchInAnEdge) {
  for (const double gap : {60.0, 20.0, 5.0}) expect_right(acute::wedges_touching_in_an_edge(30, gap));
  for (const double gap : {90.0, 60.0, 30.0, 10.0}) expect_right(acute::cubes_touching_in_an_edge(gap));
}

TEST(Collar, SolidsThatTouchInAVertex) {
  for (const unsigned k : {3U, 4U, 6U})
    for (const double angle : {90.0, 60.0, 20.0, 5.0}) expect_right(acute::pyramids_tip_to_tip(k, angle));
  expect_right(acute::cubes_touching_in_a_corner());
  for (const double angle : {20.0, 60.0, 120.0, 160.0}) expect_right(acute::pyramid_on_a_box(angle));
}

TEST(Collar, FacetsThatEndInside) {
  for (const double angle : {70.0, 45.0, 20.0, 10.0, 3.0}) expect_right(acute::facet_ending_inside(angle));
}

TEST(Collar, SegmentsAlone) {
  for (const double angle : {70.0, 45.0, 20.0, 10.0, 3.0})
    expect_right(acute::segment_meeting_a_facet(angle));
  for (const unsigned count : {2U, 5U, 12U}) expect_right(acute::segments_from_a_point(count, count));
}

TEST(Collar, FeaturesThatPassCloseToACrease) {
  for (const double angle : {50.0, 20.0})
    for (const double distance : {0.3, 0.1, 0.03}) {
      expect_right(acute::segment_near_a_crease(angle, distance));
      expect_right(acute::segment_near_a_crease(angle, distance, true));
      expect_right(acute::facet_near_a_crease(angle, distance));
    }
}

Meshed tiny_pairs(double pair, std::uint32_t seed) {
  const PolygonSoup soup = acute::pairs_in_a_box(4, pair, seed).soups[0];
  PlcOptions complex;
  complex.feature_angle = 0;
  complex.weld = 0;
  return testing::mesh_of(build_plc({&soup, 1}, complex), testing::with_size(0.5));
}

// The floor of the refinement is as low relative to tiny edges as it is elsewhere relative to the diagonal.
// The number of vertices grows with the logarithm of the spread.
TEST(Collar, TinyPairsAtAnySpread) {
  std::size_t before = 0;
  for (const double pair : {1e-5, 1e-7, 1e-8, 1e-9})
    for (const std::uint32_t seed : {1U, 2U}) {
      SCOPED_TRACE(pair);
      const Meshed meshed = tiny_pairs(pair, seed);
      EXPECT_EQ(meshed.result.status, MeshStatus::complete) << meshed.result.message;
      EXPECT_EQ(testing::faults(meshed), "");
      const std::size_t inserted = meshed.result.statistics.vertices_inserted;
      EXPECT_LT(inserted, before == 0 ? 10'000 : 3 * before / 2);
      before = inserted;
    }
}

// If doubles are too coarse to separate features, the mesh misses guarantees, but no tet or triangle has a
// corner twice.
TEST(Collar, NoCornerIsRepeatedWhereRefinementGivesUp) {
  const auto repeats = [](auto corners) {
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
  };
  std::size_t given_up = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Meshed meshed = tiny_pairs(1e-11, seed);
    const TetMesh& mesh = meshed.result.mesh;
    given_up += meshed.result.status == MeshStatus::guarantee_missed ? 1 : 0;
    EXPECT_TRUE(std::none_of(mesh.tets.begin(), mesh.tets.end(), repeats));
    EXPECT_TRUE(std::none_of(mesh.faces.begin(), mesh.faces.end(), repeats));
    EXPECT_TRUE(std::none_of(mesh.edges.begin(), mesh.edges.end(), repeats));
  }
  EXPECT_GT(given_up, 0U);
}

TEST(Collar, Combs) {
  for (const unsigned teeth : {1U, 3U, 8U})
    for (const double angle : {30.0, 10.0}) expect_right(acute::comb(teeth, angle));
}

TEST(Collar, RandomMembersOfEveryFamily) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed)
    for (const acute::Shape& shape : acute::random_members(seed)) expect_right(shape);
}

TEST(Collar, RoundCones) {
  for (const double half_angle : {45.0, 40.0, 30.0, 20.0, 15.0, 8.0, 5.0, 2.0})
    expect_right(acute::round_cone(half_angle));
}

TEST(Collar, Lenses) {
  for (const double angle : {120.0, 60.0, 50.0, 40.0, 30.0, 20.0, 10.0}) expect_right(acute::lens(angle));
}

TEST(Collar, CutTori) {
  for (const double plane : {-0.6, -0.3, 0.0, 0.3, 0.5, 0.55, 0.6, 0.7, 0.8, 0.9, 0.95})
    expect_right(acute::cut_torus(plane));
}

TEST(Collar, RimsAndSheetsThatComeBack) {
  for (const double width : {0.5, 0.2, 0.1}) expect_right(acute::long_lens(40, width));
  for (const double angle : {50.0, 20.0, 10.0, 5.0, 3.0, 2.0}) expect_right(acute::drop_bar(angle));
  for (const double angle : {75.0, 100.0, 130.0})
    for (const double apex_angle : {45.0, 30.0, 15.0}) expect_right(acute::drop_cone(angle, apex_angle));
}

// A dent in a side of a box. One of its faces continues that side around a bend that is no feature, so this
// smooth patch passes through corner 8 in two sheets. The balls there are smaller than the distance
// tolerance.
TEST(Collar, SheetsOfOnePatchAtACorner) {
  PolygonSoup soup;
  soup.points = {{9, 0, -4},        {13, 0, -4},           {13, 0, 1},         {9, 0, 1},
                 {9, 2, -4},        {13, 2, -4},           {13, 2, 1},         {9, 2, 1},
                 {11.4, 0, -1.442}, {11.3455, 0, -1.2646}, {10.5, 0, -1.4418}, {11.4, 0.143, -1.2439}};
  const auto facet = [&](const std::vector<Index>& corners) { soup.add_facet(corners); };
  soup.begin_facet();
  soup.add_polygon(std::vector<Index>{0, 1, 2, 3});
  soup.add_polygon(std::vector<Index>{8, 9, 10});
  soup.facet_holes.push_back({0, {11.1, 0, -1.4}});
  facet({7, 6, 5, 4});
  facet({0, 4, 5, 1});
  facet({1, 5, 6, 2});
  facet({2, 6, 7, 3});
  facet({3, 7, 4, 0});
  facet({9, 11, 8});
  facet({11, 10, 8});
  facet({11, 9, 10});
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    MeshOptions options = testing::with_size(0.5);
    options.bounds.distance = 0.065;
    options.seed = seed;
    EXPECT_EQ(testing::faults(testing::mesh_of(soup, options, 37)), "") << seed;
  }
}

TEST(Collar, CurvedSheetsInsideARegion) {
  for (const double angle : {55.0, 30.0, 15.0, 5.0}) expect_right(acute::curved_facet_ending_inside(angle));
  for (const double angle : {20.0, 75.0, 100.0}) expect_right(acute::drop_cone_in_a_room(angle, 30));
}

bool has_finding(const TetMesh& mesh, const Plc& plc, const std::string& guarantee) {
  const CheckReport report = check(mesh, plc);
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& finding) { return finding.guarantee == guarantee; });
}

// The lemmas on the balls of collars are part of the certificate.
TEST(Collar, WrongBallsAreFound) {
  const acute::Shape wedge = acute::wedge(30);
  const Meshed meshed = testing::mesh_of(wedge.soups, testing::with_size(size), 0);
  ASSERT_EQ(testing::faults(meshed), "");
  ASSERT_FALSE(meshed.result.mesh.collar_balls.empty());
  TetMesh mesh = meshed.result.mesh;
  for (TetMesh::CollarBall& ball : mesh.collar_balls) ball.radius *= 1.2;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "collar_gap"));
  mesh = meshed.result.mesh;
  for (TetMesh::CollarBall& ball : mesh.collar_balls) ball.radius *= 0.3;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "collar_disjoint"));
  mesh = meshed.result.mesh;
  *std::find(mesh.tet_collar.begin(), mesh.tet_collar.end(), 2) = 1;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "collar_cells"));
  mesh = meshed.result.mesh;
  mesh.collar_balls[0].radius = -1;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "valid_arrays"));
  mesh = meshed.result.mesh;
  mesh.collar_balls[0].centre.x = NAN;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "valid_arrays"));
  mesh = meshed.result.mesh;
  mesh.collar_balls[0].centre.x += 0.01;
  EXPECT_TRUE(has_finding(mesh, meshed.plc, "collar_centre"));
}

// A file may lack the marks of cells, or all labels; the complex knows the creases.
TEST(Collar, FilesAreJudgedByTheCreasesOfTheComplex) {
  const acute::Shape wedge = acute::wedge(20);
  const Meshed meshed = testing::mesh_of(wedge.soups, testing::with_size(size), 0);
  ASSERT_EQ(testing::faults(meshed), "");
  TetMesh mesh = meshed.result.mesh;
  mesh.features.clear();
  mesh.collar_balls.clear();
  EXPECT_TRUE(check(mesh, meshed.plc).passed());
  EXPECT_EQ(check(mesh, meshed.plc).collar_tets, meshed.report.collar_tets);
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  EXPECT_TRUE(check(mesh, meshed.plc).passed());
  EXPECT_EQ(check(mesh, meshed.plc).collar_tets, meshed.report.collar_tets);
  mesh.edges.clear();
  mesh.edge_curve.clear();
  mesh.edge_tag.clear();
  EXPECT_EQ(check(mesh, meshed.plc).collar_tets, meshed.report.collar_tets);
  EXPECT_TRUE(check(mesh, meshed.plc).passed());
  mesh = meshed.result.mesh;
  CheckOptions no_creases;
  no_creases.bounds.crease_angle = 10;
  const CheckReport report = check(mesh, meshed.plc, no_creases);
  EXPECT_GE(report.findings_total, meshed.report.collar_tets);
  EXPECT_EQ(report.findings.front().guarantee, "collar_cells");
}

// Cancelling and time budgets also end the placement of balls.
TEST(Collar, PlacementCanBeStopped) {
  PlcOptions smooth;
  smooth.feature_angle = 30;
  const Plc plc = build_plc(acute::lens(20).soups, smooth);
  // Up front every ball asks whether to stop; in the pass the loop asks every 512 steps.
  using Most = std::pair<CollarCreation, std::size_t>;
  for (const auto& [creation, most_asked] :
       {Most{CollarCreation::up_front, 10}, Most{CollarCreation::in_pass, 1024}}) {
    SCOPED_TRACE(creation == CollarCreation::in_pass ? "in the pass" : "up front");
    std::atomic<bool> cancel = false;
    bool stops = false;
    std::size_t asked = 0;
    MeshOptions options = testing::with_size(size);
    options.collar_creation = creation;
    options.size_field = [&](const Point&) {
      cancel = stops;
      ++asked;
      return size;
    };
    EXPECT_EQ(generate(plc, options, {.progress = {}, .cancel = &cancel}).status, MeshStatus::complete);
    EXPECT_GT(asked, most_asked);
    stops = true;
    asked = 0;
    EXPECT_EQ(generate(plc, options, {.progress = {}, .cancel = &cancel}).status, MeshStatus::cancelled);
    EXPECT_LT(asked, most_asked);
    options = testing::with_size(0.001);  // tens of thousands of balls
    options.collar_creation = creation;
    options.bounds.distance = 1e-7;
    options.time_limit = 1e-3;
    EXPECT_EQ(generate(plc, options).status, MeshStatus::budget_hit);
  }
}

// Checks other sizes, seeds and bounds.
TEST(Collar, SizesAndSeeds) {
  const std::vector<acute::Shape> shapes{acute::wedge(20), acute::pyramid(4, 40), acute::star_prism(5, 0.4)};
  for (const acute::Shape& shape : shapes)
    for (const double edge : {1.0, 0.1})
      for (const std::uint64_t seed : {0U, 7U}) {
        SCOPED_TRACE(shape.name);
        MeshOptions options = testing::with_size(edge);
        options.seed = seed;
        EXPECT_EQ(testing::faults(testing::mesh_of(shape.soups, options, 0)), "");
      }
}

TEST(Collar, TighterAngle) {
  for (const double angle : {20.0, 40.0}) {
    MeshOptions options = testing::with_size(size);
    options.bounds.collar_angle = 140;
    EXPECT_EQ(testing::faults(testing::mesh_of(acute::wedge(angle).soups, options, 0)), "");
  }
}

// Checks the same in other units and far from the origin.
TEST(Collar, MovedAndScaled) {
  const std::vector<acute::Shape> shapes{acute::wedge(20), acute::pyramid(5, 30), acute::sectors(8)};
  for (const acute::Shape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    for (const double scale : {1e-6, 1e6}) {
      std::vector<PolygonSoup> soups = shape.soups;
      for (PolygonSoup& soup : soups)
        for (Point& p : soup.points) p = scale * p;
      EXPECT_EQ(testing::faults(testing::mesh_of(soups, testing::with_size(size * scale), 0)), "");
    }
    std::vector<PolygonSoup> soups = shape.soups;
    for (PolygonSoup& soup : soups)
      for (Point& p : soup.points) p = p + Vector{1e6, -2e6, 5e5};
    EXPECT_EQ(testing::faults(testing::mesh_of(soups, testing::with_size(size), 0)), "");
  }
}

}  // namespace
}  // namespace collarmesh::collar_test
