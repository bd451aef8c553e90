// Meshes adapted to sizes, finer or coarser: the lengths are reached, everything else is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapt/mesh_complex.h"
#include "collarmesh/error.h"
#include "collarmesh/mesh_measures.h"
#include "collarmesh/remesh.h"
#include "common/sorted.h"
#include "constrained/constrained_tetrahedra.h"
#include "remesh/operations.h"
#include "support/meshes.h"
#include "support/shapes.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::remesh_test {
namespace {

using namespace testing;

PipelineOptions of_size(double size, unsigned threads = 0) {
  PipelineOptions options;
  options.mesh.size = size;
  options.mesh.threads = threads;
  options.mesh.max_vertices = 300'000;
  return options;
}

PipelineOptions of_field(SizeField field) {
  PipelineOptions options = of_size(0);
  options.mesh.size_field = std::move(field);
  return options;
}

std::string faults(const RemeshResult& made) {
  return made.guarantees_hold() ? std::string() : "not certified: " + made.missed();
}

/// Returns the ratio of each edge to its target, sorted.
std::vector<double> relative_lengths(const TetMesh& mesh, const SizeField& size) {
  std::set<std::pair<Index, Index>> edges;
  for (const auto& tet : mesh.tets)
    for (const Index v : tet)
      for (const Index w : tet)
        if (v < w) edges.emplace(v, w);
  std::vector<double> lengths;
  for (const auto& [v, w] : edges) {
    const Point &a = mesh.points[v], &b = mesh.points[w];
    lengths.push_back(distance(a, b) / size(0.5 * (a + b)));
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

void expect_lengths(const TetMesh& mesh, const SizeField& size) {
  const std::vector<double> lengths = relative_lengths(mesh, size);
  EXPECT_GT(lengths[lengths.size() / 2], 0.8);
  EXPECT_LT(lengths[lengths.size() / 2], 1.2);
  EXPECT_LT(lengths[lengths.size() * 95 / 100], 1.6);
}

std::map<Tag, double> volumes(const TetMesh& mesh) {
  std::map<Tag, double> volumes;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.tet_tag[t]] +=
        six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  }
  return volumes;
}

std::map<Tag, double> areas(const TetMesh& mesh) {
  std::map<Tag, double> areas;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    areas[mesh.face_tag[f]] +=
        0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  }
  return areas;
}

std::map<Tag, double> curve_lengths(const TetMesh& mesh) {
  std::map<Tag, double> lengths;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    lengths[mesh.edge_tag[e]] += distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]);
  return lengths;
}

void expect_near(const std::map<Tag, double>& before, const std::map<Tag, double>& after, double share) {
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [tag, value] : before) {
    ASSERT_TRUE(after.contains(tag)) << tag;
    EXPECT_NEAR(after.at(tag), value, share * value) << tag;
  }
}

void expect_parts_kept(const TetMesh& before, const TetMesh& after, double share) {
  expect_near(volumes(before), volumes(after), share);
  expect_near(areas(before), areas(after), share);
  expect_near(curve_lengths(before), curve_lengths(after), share);
}

TetMesh meshed(const std::vector<PolygonSoup>& soups, double size, double feature_angle = 30) {
  PipelineOptions options = of_size(size);
  options.complex.feature_angle = feature_angle;
  SoupPipelineResult made = run_pipeline(soups, options);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  return without_features(std::move(made.result.mesh));
}

struct Shape {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
  double allowed;  // share by which volumes, areas and lengths of curves may change
};

std::vector<Shape> shapes() {
  return {{"box", {box()}, 0.2, 1e-9},
          {"L", {l_shape()}, 0.3, 1e-9},
          {"two boxes", {two_boxes()}, 0.25, 1e-9},
          {"touching boxes", touching_boxes(), 0.25, 1e-9},
          {"cavity", {box_with_cavity(0.3)}, 0.2, 1e-9},
          {"dangling facet", {box_with_dangling_facet()}, 0.2, 1e-9},
          {"plate with a hole", {plate_with_hole(1, 32)}, 0.5, 0.03},
          {"ball", {icosphere(1, 8)}, 0.3, 0.05},
          {"ball in a box", {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.6, 8)}, 0.3, 0.05}};
}

class RemeshedShape : public ::testing::TestWithParam<Shape> {};

TEST_P(RemeshedShape, ReachesFinerAndCoarserSizes) {
  const auto& [name, soups, size, allowed] = GetParam();
  const TetMesh mesh = meshed(soups, size);
  for (const double factor : {0.5, 1.8}) {
    SCOPED_TRACE(factor);
    const RemeshResult made = remesh(mesh, of_size(factor * size));
    ASSERT_EQ(faults(made), "");
    expect_parts_kept(mesh, made.result.mesh, allowed);
    const double asked = factor * size;
    if (factor < 1)
      expect_lengths(made.result.mesh, [asked](const Point&) { return asked; });
    else  // by 1.8^3 where no feature keeps edges short
      EXPECT_LT(made.result.mesh.tets.size(), 0.7 * static_cast<double>(mesh.tets.size()));
  }
}

TEST_P(RemeshedShape, KeepsItsPartsOverSixLoops) {
  const auto& [name, soups, size, allowed] = GetParam();
  const TetMesh first = meshed(soups, size);
  TetMesh mesh = first;
  for (unsigned loop = 0; loop < 6; ++loop) {
    RemeshResult made = remesh(mesh, of_size(loop % 2 == 0 ? 0.6 * size : 1.3 * size));
    ASSERT_EQ(faults(made), "") << loop;
    EXPECT_GT(made.check.min_dihedral, 8) << loop;
    EXPECT_LT(made.check.max_dihedral, 151) << loop;
    mesh = without_features(std::move(made.result.mesh));
  }
  expect_parts_kept(first, mesh, allowed);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RemeshedShape, ::testing::ValuesIn(shapes()), [](const auto& shape) {
  std::string name = shape.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// The labels of the new mesh are those of the input from which the first mesh was made.
TEST(Remesh, IsAMeshOfTheFirstInput) {
  for (const PolygonSoup& soup : {two_boxes(), plate_with_hole(1, 32), box_with_dangling_facet()}) {
    const SoupPipelineResult first = run_pipeline(std::vector{soup}, of_size(0.4));
    ASSERT_TRUE(first.guarantees_hold()) << first.missed();
    for (const TetMesh& mesh : {first.result.mesh, without_features(first.result.mesh)}) {
      const RemeshResult made = remesh(mesh, of_size(0.3));
      ASSERT_EQ(faults(made), "");
      const CheckReport report = check(made.result.mesh, first.plc);
      EXPECT_TRUE(report.passed()) << report.findings.front().message;
    }
  }
}

TEST(Remesh, FollowsAField) {
  const SizeField field = [](const Point& p) { return 0.04 + 0.3 * norm(p); };
  const TetMesh mesh = meshed({box()}, 0.3);
  const RemeshResult made = remesh(mesh, of_field(field));
  ASSERT_EQ(faults(made), "");
  expect_lengths(made.result.mesh, field);
  // Then adapts this mesh to a field that is fine at the other end.
  const SizeField other = [](const Point& p) { return 0.04 + 0.3 * distance(p, {1, 1, 1}); };
  const RemeshResult again = remesh(made.result.mesh, of_field(other));
  ASSERT_EQ(faults(again), "");
  expect_lengths(again.result.mesh, other);
}

// The fine place is between the vertices of the first mesh.
TEST(Remesh, SeesAFieldBetweenVertices) {
  const SizeField field = [](const Point& p) {
    return std::min(0.5, 0.03 + 0.4 * distance(p, {0.37, 0.41, 0.43}));
  };
  const RemeshResult made = remesh(meshed({box()}, 0.5), of_field(field));
  ASSERT_EQ(faults(made), "");
  double shortest = INFINITY;
  for (const auto& [a, b, c, d] : made.result.mesh.tets)
    shortest = std::min(shortest, distance(made.result.mesh.points[a], made.result.mesh.points[b]));
  EXPECT_LT(shortest, 0.06);
}

TEST(Remesh, DoesNotDependOnThreads) {
  const TetMesh mesh = meshed({box({-1, -1, -1}, {1, 1, 1}), icosphere(0.6, 8)}, 0.35);
  const RemeshResult one = remesh(mesh, of_size(0.2, 1));
  ASSERT_EQ(faults(one), "");
  expect_same(one.result.mesh, remesh(mesh, of_size(0.2, 1)).result.mesh);
  expect_same(one.result.mesh, remesh(mesh, of_size(0.2, 4)).result.mesh);
}

TEST(Remesh, DividesEdgesFarFromTheComplex) {
  PipelineOptions options = of_size(0.8);
  options.mesh.bounds.distance = 0.3;
  const SoupPipelineResult coarse = run_pipeline(std::vector{icosphere(1, 8)}, options);
  ASSERT_TRUE(coarse.guarantees_hold()) << coarse.missed();
  ASSERT_GT(coarse.check.max_surface_distance, 0.05);
  options.mesh.bounds.distance = 0.03;
  const RemeshResult made = remesh(without_features(coarse.result.mesh), coarse.plc, options);
  EXPECT_EQ(faults(made), "");
  EXPECT_LT(made.check.max_surface_distance, 0.5 * coarse.check.max_surface_distance);
}

/// Returns the largest distance of the nodes on faces from the unit sphere.
double off_sphere(const TetMesh& mesh) {
  double off = 0;
  for (const auto& face : mesh.faces)
    for (const Index v : face) off = std::max(off, std::fabs(norm(mesh.points[v]) - 1));
  return off;
}

TEST(Remesh, ReconstructsASmoothSurface) {
  PipelineOptions options = of_size(0.5);
  options.mesh.bounds.distance = 0.12;
  const SoupPipelineResult coarse = run_pipeline(std::vector{icosphere(1, 16)}, options);
  ASSERT_TRUE(coarse.guarantees_hold()) << coarse.missed();
  options.complex.feature_angle = 60;
  TetMesh smooth = without_features(coarse.result.mesh), straight = smooth;
  const double volume = volumes(smooth).begin()->second;
  for (const double size : {0.35, 0.25}) {
    options.mesh.size = size;
    options.smooth_surface = false;
    straight = remesh(straight, options).result.mesh;
    options.smooth_surface = true;
    const RemeshResult made = remesh(smooth, options);
    ASSERT_EQ(faults(made), "");
    smooth = made.result.mesh;
  }
  EXPECT_GT(off_sphere(straight), 0.05);
  EXPECT_LT(off_sphere(smooth), 0.01);
  const double whole = 4 * std::acos(-1.0) / 3;
  EXPECT_LT(whole - volumes(smooth).begin()->second, 0.4 * (whole - volume));
  EXPECT_GT(whole - volumes(straight).begin()->second, 0.9 * (whole - volume));
}

TEST(Remesh, ReconstructsNoSurfaceThatIsGiven) {
  const SoupPipelineResult made = run_pipeline(std::vector{icosphere(1, 4)}, of_size(0.5));
  PipelineOptions options = of_size(0.4);
  options.smooth_surface = true;
  EXPECT_THROW(remesh(without_features(made.result.mesh), made.plc, options), OptionError);
}

TEST(Remesh, KeepsLengthsWithoutASize) {
  const TetMesh mesh = meshed({l_shape()}, 0.2);
  const RemeshResult made = remesh(mesh, of_size(0));
  ASSERT_EQ(faults(made), "");
  EXPECT_NEAR(static_cast<double>(made.result.mesh.tets.size()), static_cast<double>(mesh.tets.size()),
              0.3 * static_cast<double>(mesh.tets.size()));
}

TEST(Remesh, TakesSecondOrderAndMakesIt) {
  PipelineOptions options = of_size(0.4);
  options.order = 2;
  const SoupPipelineResult first = run_pipeline(std::vector{icosphere(1, 8)}, options);
  ASSERT_TRUE(first.guarantees_hold());
  options.mesh.size = 0.3;
  const RemeshResult made = remesh(without_features(first.result.mesh), options);
  ASSERT_EQ(faults(made), "");
  EXPECT_EQ(made.result.mesh.order(), 2);
  EXPECT_GT(made.second_order.curved, 0U);
}

/// A mesh whose inner vertices were moved, so that many tets are nearly flat but none is inverted.
TetMesh shaken(Index n) {
  TetMesh mesh = meshed_box(n).mesh;
  std::uint32_t state = 1;
  const auto random = [&state] {
    return static_cast<double>((state = state * 1664525 + 1013904223) >> 8) / 0x1p24 - 0.5;
  };
  const auto smallest_at = [&](Index v) {
    double least = INFINITY;
    for (const auto& tet : mesh.tets)
      if (std::find(tet.begin(), tet.end(), v) != tet.end())
        least = std::min(least, six_volume(mesh.points[tet[0]], mesh.points[tet[1]], mesh.points[tet[2]],
                                           mesh.points[tet[3]]));
    return least;
  };
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (mesh.features[v].dimension != 3) continue;
    const Point before = mesh.points[v];
    const Vector way{random(), random(), random()};
    for (double share = 4; share > 0.01; share *= 0.9) {
      mesh.points[v] = before + (share / n) * way;
      if (smallest_at(v) > 1e-9) break;
      mesh.points[v] = before;
    }
  }
  return without_features(std::move(mesh));
}

TEST(Remesh, MakesBadTetsGood) {
  const TetMesh mesh = shaken(5);
  const MeshMeasures before = measure_mesh(mesh);
  ASSERT_LT(before.min_dihedral, 3) << "the test needs bad tets";
  const RemeshResult made = remesh(mesh, of_size(0.2));
  ASSERT_EQ(faults(made), "");
  EXPECT_GT(made.check.min_dihedral, 12);
  EXPECT_LT(made.check.max_dihedral, 150);
  EXPECT_EQ(made.remeshing.smallest_angle_before, before.min_dihedral);
}

// Triangulations of nothing but the vertices of the surface, as other programs write them: nearly all tets
// are needles and slivers.
TEST(Remesh, MakesTriangulationsOfASurfaceGood) {
  for (const PolygonSoup& soup : {plate_with_hole(0.2, 40), torus(3, 1, 24, 12), cylinder(1, 3, 32, 5)}) {
    const ConstrainedTetrahedra given = constrained_tetrahedra(build_plc(std::vector{soup}));
    const RemeshResult made = remesh(without_features(given.mesh), of_size(0));
    EXPECT_EQ(faults(made), "");
    EXPECT_LT(made.remeshing.smallest_angle_before, 3);
    expect_near(volumes(given.mesh), volumes(made.result.mesh), 0.02);
  }
}

// Short edges across the plate lower the bounds on angles. Tets within these bounds are not poor.
TEST(Remesh, KeepsTheLengthsOfAThinPlate) {
  const TetMesh plate = meshed({box({0, 0, 0}, {10, 10, 0.1})}, 1);
  const RemeshResult made = remesh(plate, of_size(1));
  const double before = static_cast<double>(plate.tets.size());
  EXPECT_NEAR(static_cast<double>(made.result.mesh.tets.size()), before, 0.3 * before);
}

TEST(Remesh, FindsFeaturesOfAMeshWithoutTags) {
  TetMesh mesh = meshed({l_shape()}, 0.3);
  const double volume = volumes(mesh).begin()->second;
  mesh.faces.clear(), mesh.face_tag.clear(), mesh.face_patch.clear(), mesh.face_regions.clear();
  mesh.edges.clear(), mesh.edge_tag.clear(), mesh.edge_curve.clear();
  const RemeshResult made = remesh(mesh, of_size(0.2));
  ASSERT_EQ(faults(made), "");
  EXPECT_EQ(made.plc.patches.size(), 8U);
  EXPECT_EQ(made.plc.curves.size(), 18U);
  EXPECT_NEAR(volumes(made.result.mesh).begin()->second, volume, 1e-9);
}

TEST(Remesh, IgnoresThatEverySideIsListed) {
  TetMesh mesh = meshed({box()}, 0.5);
  std::set<std::array<Index, 3>> listed;
  for (const auto& face : mesh.faces) listed.insert(sorted(face));
  for (const auto& [a, b, c, d] : std::vector(mesh.tets))
    for (const std::array<Index, 3>& side : {std::array{b, c, d}, {a, d, c}, {a, b, d}, {a, c, b}})
      if (listed.insert(sorted(side)).second) mesh.faces.push_back(side);
  mesh.face_tag.resize(mesh.faces.size(), 0);
  mesh.face_patch.resize(mesh.faces.size(), none);
  mesh.face_regions.resize(mesh.faces.size(), {1, 1});
  const RemeshResult made = remesh(mesh, of_size(0.3));
  ASSERT_EQ(faults(made), "");
  EXPECT_EQ(made.plc.patches.size(), 6U);
}

TEST(Remesh, NamesWhatDoesNotFit) {
  const TetMesh mesh = meshed({box()}, 0.5);
  const auto message = [](const TetMesh& wrong) -> std::string {
    try {
      remesh(wrong, of_size(0.4));
    } catch (const PlcError& error) {
      return error.what();
    }
    return "nothing is wrong";
  };
  TetMesh twice = mesh;
  twice.tets.push_back(mesh.tets[0]);
  twice.tet_tag.push_back(1), twice.tet_region.push_back(1);
  EXPECT_NE(message(twice).find("is a side of 3 tetrahedra"), std::string::npos) << message(twice);
  TetMesh cracked = mesh;
  cracked.points.push_back(mesh.points[mesh.tets[0][0]]);
  cracked.tets[0][0] = static_cast<Index>(mesh.points.size());
  EXPECT_NE(message(cracked).find("merge such nodes"), std::string::npos) << message(cracked);
  TetMesh strange = mesh;
  strange.faces.push_back({mesh.faces[0][0], mesh.faces[1][1], mesh.faces[mesh.faces.size() / 2][2]});
  strange.face_tag.push_back(9);
  EXPECT_NE(message(strange).find("is no side of a tetrahedron"), std::string::npos) << message(strange);
  EXPECT_NE(message({}).find("no tetrahedra"), std::string::npos) << message({});
  TetMesh alone = mesh;  // a node without a tet comes first, so that all others have another number inside
  alone.points.insert(alone.points.begin(), {9, 9, 9});
  for (auto& tet : alone.tets)
    for (Index& v : tet) ++v;
  for (auto& face : alone.faces)
    for (Index& v : face) ++v;
  for (auto& edge : alone.edges)
    for (Index& v : edge) ++v;
  alone.features.insert(alone.features.begin(), TetMesh::VertexFeature{});
  TetMesh inverted = alone;
  const auto& side = inverted.faces[0];
  const auto on_boundary = std::find_if(inverted.tets.begin(), inverted.tets.end(), [&](const auto& tet) {
    return std::all_of(side.begin(), side.end(),
                       [&](Index v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); });
  });
  ASSERT_NE(on_boundary, inverted.tets.end());
  std::swap((*on_boundary)[0], (*on_boundary)[1]);
  const std::string first =
      "nodes " + std::to_string((*on_boundary)[0]) + ", " + std::to_string((*on_boundary)[1]) + ", ";
  EXPECT_NE(message(inverted).find("is inverted"), std::string::npos) << message(inverted);
  EXPECT_NE(message(inverted).find(first), std::string::npos) << message(inverted);
  alone.faces.push_back({0, 1, 2});
  alone.face_tag.push_back(9);
  EXPECT_NE(message(alone).find("node 0 at (9, 9, 9) belongs to no tetrahedron"), std::string::npos)
      << message(alone);
  EXPECT_THROW(remesh(mesh,
                      [] {
                        PipelineOptions options = of_size(0.4);
                        options.mesh.patch_size[77] = 0.1;
                        return options;
                      }()),
               OptionError);
}

TEST(Remesh, MayBeginAboveABudget) {
  const TetMesh mesh = meshed({box()}, 0.15);
  PipelineOptions options = of_size(0.5);
  options.mesh.max_vertices = mesh.points.size() / 2;
  const RemeshResult made = remesh(mesh, options);
  EXPECT_EQ(faults(made), "");
  EXPECT_LT(made.result.mesh.points.size(), options.mesh.max_vertices);
}

TEST(Remesh, EndsAtABudget) {
  PipelineOptions options = of_size(0.02);
  options.mesh.max_vertices = 2000;
  const RemeshResult made = remesh(meshed({box()}, 0.5), options);
  EXPECT_EQ(made.result.status, MeshStatus::budget_hit);
  EXPECT_TRUE(made.result.mesh.tets.empty());
  EXPECT_NE(made.result.message.find("2000"), std::string::npos);
}

// All edges of a mesh are divided in a trial, and everything is undone.
TEST(DividedEdges, AreUndone) {
  using namespace remeshing;
  for (const TetMesh& mesh : {meshed_two_boxes(3).mesh, meshed({icosphere(1, 6)}, 0.5)}) {
    remeshing::adapting::MeshComplex given = remeshing::adapting::complex_of(mesh, {});
    const TetMesh before = given.mesh;
    EditableMesh edited(given.mesh, given.plc, tolerance_of(given.plc, {}, 0.3));
    edited.prepare();
    const ThinRule rule(
        {ThinShape(given.plc, given.mesh, 8, 0, edited.forced), CellBounds(given.plc, given.mesh, {})});
    Operations operations(edited, rule);
    const auto divide_all = [&] {
      std::map<unsigned, unsigned> divided;
      std::set<std::pair<Index, Index>> edges;
      for (const auto& tet : before.tets)
        for (const Index v : tet)
          for (const Index w : tet)
            if (v < w) edges.emplace(v, w);
      for (const auto& [a, b] : edges) {
        if (edited.complex.tet_at_edge(a, b) == none) continue;
        Change change;
        operations.divide_edge(a, b, 0.5, 0, change);
        if (change.kind == Change::Kind::none) continue;
        ++divided[change.feature.dimension];
        edited.apply(std::move(change));
      }
      return divided;
    };
    remeshing::Trial once(edited);
    const auto first = divide_all();
    once.undo();
    EXPECT_EQ(given.mesh.points, before.points);
    EXPECT_EQ(given.mesh.edges, before.edges);
    remeshing::Trial again(edited);
    EXPECT_EQ(divide_all(), first);
    again.undo();
    edited.store();
    expect_same(given.mesh, before);
    for (const unsigned dimension : {1U, 2U, 3U})
      EXPECT_EQ(first.contains(dimension), dimension > 1 || !before.edges.empty()) << dimension;
  }
}

TEST(DividedEdges, KeepCurvesWhole) {
  remeshing::adapting::MeshComplex given =
      remeshing::adapting::complex_of(meshed({plate_with_hole(1, 24)}, 0.6), {});
  const auto before = curve_lengths(given.mesh);
  remeshing::EditableMesh edited(given.mesh, given.plc, tolerance_of(given.plc, {}, 0.6));
  edited.prepare();
  const remeshing::ThinRule rule({remeshing::ThinShape(given.plc, given.mesh, 8, 0, edited.forced),
                                  remeshing::CellBounds(given.plc, given.mesh, {})});
  remeshing::Operations operations(edited, rule);
  std::size_t divided = 0;
  for (unsigned round = 0; round < 3; ++round)
    for (const auto& [a, b] : std::vector(given.mesh.edges)) {
      remeshing::Change change;
      operations.divide_edge(a, b, 0.5, 0, change);
      if (change.kind == remeshing::Change::Kind::none) continue;
      ++divided;
      edited.apply(std::move(change));
    }
  edited.store();
  EXPECT_GT(divided, 6 * before.size());
  expect_near(before, curve_lengths(given.mesh), 1e-12);
  EXPECT_TRUE(check(given.mesh, given.plc, {.bounds = {.radius_edge = 1e9}}).passed());
}

}  // namespace
}  // namespace collarmesh::remesh_test
