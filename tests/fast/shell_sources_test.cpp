// Triangles and lines of complexes that are built from soups: on exact geometry, of some faces, with and
// without repair, and stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/shells.h"
#include "support/repair_shapes.h"
#include "support/shapes.h"
#include "support/tagged_cylinder.h"

namespace collarmesh::shell_sources_test {
namespace {

using namespace testing;

constexpr double pi = std::numbers::pi;

/// The exact geometry of round cylinders about the z axis whose radius is 1.
ExactGeometry on_cylinder(const Plc& plc) {
  return [&plc](unsigned dimension, Index feature, const Point& p) -> std::optional<Point> {
    if (dimension == 2 && plc.patches[feature].planar) return std::nullopt;
    if (dimension == 1 && plc.curves[feature].straight) return std::nullopt;
    const double radius = std::hypot(p.x, p.y);
    return Point{p.x / radius, p.y / radius, p.z};
  };
}

/// A source of complexes that counts the calls for each mode of repair, and sets the exact geometry.
class Source : public ComplexSource {
 public:
  explicit Source(const PolygonSoup& soup, bool exact = false) : soup_(soup), exact_(exact) {
    complex_.require_solid = false;
  }
  RepairedPlc build(const RepairOptions& repair, const Execution& execution) override {
    modes_.push_back(repair.mode);
    return build_repaired_plc({&soup_, 1}, complex_, repair, execution);
  }
  void adapt(const Plc& plc, PipelineOptions& options) override {
    if (exact_) options.exact = on_cylinder(plc);
    options.exact_measures = measures_of(plc);
  }
  const std::vector<RepairMode>& modes() const { return modes_; }

 private:
  const PolygonSoup& soup_;
  bool exact_;
  PlcOptions complex_;
  std::vector<RepairMode> modes_;
};

PipelineOptions asked(double size, unsigned dimension = 2, unsigned order = 1) {
  PipelineOptions options;
  options.dimension = dimension;
  options.mesh.size = size;
  options.order = order;
  return options;
}

bool is_round(const TetMesh& mesh, Index node, const Plc& plc) {
  const auto [dimension, feature] = mesh.features[node];
  return (dimension == 2 && !plc.patches[feature].planar) ||
         (dimension == 1 && !plc.curves[feature].straight);
}

double area_of(const TetMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces)
    area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  return area;
}

// The polygon of the soup has a radius of 1 only at its corners.
TEST(ShellSources, NodesLieOnTheExactGeometry) {
  const PolygonSoup soup = cylinder(1, 2, 48);
  for (const unsigned order : {1U, 2U}) {
    Source source(soup, true);
    const SoupPipelineResult made = run_pipeline(source, asked(0.3, 2, order));
    EXPECT_EQ(made.missed(), "");
    ASSERT_TRUE(made.projection);
    EXPECT_TRUE(made.projection->exceptions.empty());
    EXPECT_GT(made.projection->largest_move, 1e-5);
    EXPECT_LE(made.projection->largest_move, 1 - std::cos(pi / 48) + 1e-12);
    const TetMesh& mesh = made.result.mesh;
    std::size_t round = 0;
    for (Index v = 0; v < mesh.points.size(); ++v) {
      if (!is_round(mesh, v, made.plc)) continue;
      ++round;
      EXPECT_NEAR(std::hypot(mesh.points[v].x, mesh.points[v].y), 1, 1e-12);
    }
    EXPECT_GT(round, 100U);
    EXPECT_NEAR(area_of(mesh), 6 * pi, 0.1);
  }
}

TEST(ShellSources, LinesLieOnTheExactGeometry) {
  const PolygonSoup soup = cylinder(1, 2, 48);
  for (const unsigned order : {1U, 2U}) {
    Source source(soup, true);
    const SoupPipelineResult made = run_pipeline(source, asked(0.4, 1, order));
    EXPECT_EQ(made.missed(), "");
    ASSERT_TRUE(made.projection);
    EXPECT_GT(made.projection->vertices, 20U);
    EXPECT_LE(made.projection->largest_move, 1 - std::cos(pi / 48) + 1e-12);
    double length = 0;
    for (const auto& [a, b] : made.result.mesh.edges)
      length += distance(made.result.mesh.points[a], made.result.mesh.points[b]);
    EXPECT_NEAR(length, 4 * pi, 0.15);
    for (const Point& p : made.result.mesh.points) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-12);
  }
}

// Nodes that are farther from the exact geometry than the tolerance stay, and are told.
TEST(ShellSources, NodesFarFromTheExactGeometryStay) {
  const PolygonSoup soup = cylinder(2, 2, 48);
  for (const unsigned dimension : {1U, 2U}) {
    Source source(soup, true);
    const SoupPipelineResult made = run_pipeline(source, asked(0.8, dimension));
    ASSERT_TRUE(made.projection);
    EXPECT_EQ(made.projection->exceptions.size(), made.projection->vertices);
    EXPECT_GT(made.projection->vertices, 10U);
    EXPECT_NEAR(made.projection->largest_distance, 1, 0.01);
    for (const auto& exception : made.projection->exceptions) {
      EXPECT_NEAR(std::hypot(exception.where.x, exception.where.y), 2, 0.01);
      ASSERT_LT(exception.point, made.result.mesh.points.size());
      EXPECT_EQ(made.result.mesh.points[exception.point], exception.where);
    }
  }
}

TEST(ShellSources, ChosenFacesKeepTheirExactGeometry) {
  const PolygonSoup soup = testing::with_tagged_ends(cylinder(1, 2, 48), 2);
  Source whole(soup);
  const Plc plc = whole.build({}, {}).plc;
  ASSERT_EQ(plc.patches.size(), 3U);
  for (const Plc::Patch& patch : plc.patches) {
    Source source(soup, true);
    PipelineOptions options = asked(0.3);
    options.faces = {std::to_string(patch.tag)};
    const SoupPipelineResult made = run_pipeline(source, options);
    EXPECT_EQ(made.missed(), "");
    EXPECT_EQ(std::set<Tag>(made.result.mesh.face_tag.begin(), made.result.mesh.face_tag.end()),
              std::set<Tag>{patch.tag});
    EXPECT_NEAR(area_of(made.result.mesh), patch.planar ? pi : 4 * pi, 0.1);
    for (Index v = 0; v < made.result.mesh.points.size(); ++v)
      if (is_round(made.result.mesh, v, made.plc)) {
        EXPECT_NEAR(std::hypot(made.result.mesh.points[v].x, made.result.mesh.points[v].y), 1, 1e-12);
      }
  }
}

TEST(ShellSources, OpenSurfacesAreNotRepaired) {
  PolygonSoup open;
  const PolygonSoup whole = box();
  open.points = whole.points;
  for (Index f = 1; f < whole.facet_count(); ++f)
    open.add_facet(whole.polygon(whole.facet_polygons(f)[0]), whole.facet_tag(f));
  Source source(open);
  const SoupPipelineResult made = run_pipeline(source, asked(0.4));
  EXPECT_EQ(made.missed(), "");
  EXPECT_EQ(source.modes(), std::vector<RepairMode>{RepairMode::off});
  EXPECT_FALSE(made.repair.repaired);
  EXPECT_NEAR(area_of(made.result.mesh), 5, 1e-9);
}

// Two boxes that overlap are no complex. Their union has the surface of both without the parts inside.
TEST(ShellSources, FacetsThatAreNoComplexAreRepaired) {
  const PolygonSoup soup = joined(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.25, 0.25}, {1.5, 0.75, 0.75}));
  Source source(soup);
  const SoupPipelineResult made = run_pipeline(source, asked(0.4));
  EXPECT_EQ(made.missed(), "");
  EXPECT_EQ(source.modes(), (std::vector<RepairMode>{RepairMode::off, RepairMode::automatic}));
  EXPECT_TRUE(made.repair.repaired);
  EXPECT_NEAR(area_of(made.result.mesh), 6 + 4 * 0.5 * 0.5, 1e-9);
  PipelineOptions without = asked(0.4);
  without.repair.mode = RepairMode::off;
  Source again(soup);
  EXPECT_THROW(run_pipeline(again, without), PlcError);
  EXPECT_EQ(again.modes(), std::vector<RepairMode>{RepairMode::off});
}

// A step on the box that is lower than the tolerance.
TEST(ShellSources, SolidsWithNoiseAreRepaired) {
  constexpr double low = 3e-6;
  const PolygonSoup soup = extrusion(
      std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}, {0.5, 1 + low, 0}, {0, 1 + low, 0}},
      1);
  Source source(soup);
  const SoupPipelineResult made = run_pipeline(source, asked(0.4));
  EXPECT_EQ(made.missed(), "");
  EXPECT_EQ(source.modes(), (std::vector<RepairMode>{RepairMode::off, RepairMode::automatic}));
  EXPECT_TRUE(made.repair.repaired);
  EXPECT_NEAR(area_of(made.result.mesh), 6, 1e-4);
}

// A run that is stopped at the beginning of any stage has no mesh.
TEST(ShellSources, RunsThatAreStoppedHaveNoMesh) {
  const PolygonSoup soup = cylinder(1, 2, 48);
  std::vector<std::string> stages;
  Execution execution;
  execution.progress = [&](const ProgressReport& report) {
    if (report.begins) stages.emplace_back(report.phase);
    return true;
  };
  Source all(soup, true);
  run_pipeline(all, asked(0.4, 2, 2), execution);
  ASSERT_GE(stages.size(), 5U);
  for (const std::string& last : std::set<std::string>(stages.begin(), stages.end())) {
    SCOPED_TRACE(last);
    execution.progress = [&](const ProgressReport& report) { return report.phase != last; };
    Source source(soup, true);
    const SoupPipelineResult made = run_pipeline(source, asked(0.4, 2, 2), execution);
    EXPECT_EQ(made.result.status, MeshStatus::cancelled);
    EXPECT_EQ(made.result.message, "the run was stopped");
    EXPECT_TRUE(made.result.mesh.points.empty());
  }
}

/// A source that takes until the run is told to end.
class LateSource : public Source {
 public:
  using Source::Source;
  RepairedPlc build(const RepairOptions& repair, const Execution& execution) override {
    while (!execution.cancelled()) std::this_thread::yield();
    return Source::build(repair, execution);
  }
};

TEST(ShellSources, TheTimeLimitIsTold) {
  const PolygonSoup soup = cylinder(1, 2, 48);
  PipelineOptions options = asked(0.4);
  options.mesh.time_limit = 1e-9;
  LateSource source(soup);
  const SoupPipelineResult made = run_pipeline(source, options);
  EXPECT_EQ(made.result.status, MeshStatus::budget_hit);
  EXPECT_NE(made.result.message.find("time limit"), std::string::npos);
  EXPECT_TRUE(made.result.mesh.points.empty());
}

TEST(ShellSources, NothingToMeshIsTold) {
  PolygonSoup line;
  line.points = {{0, 0, 0}, {1, 0, 0}};
  line.segments.push_back({0, 1, 3});
  Source source(line);
  try {
    run_pipeline(source, asked(0.4));
    ADD_FAILURE();
  } catch (const PlcError& error) {
    EXPECT_NE(std::string(error.what()).find("only curves"), std::string::npos) << error.what();
  }
}

// The certificate

std::vector<std::string> guarantees_missed(const TetMesh& mesh, const Plc& plc,
                                           const CheckOptions& options = {}) {
  std::set<std::string> missed;
  for (const Finding& finding : check_shells(mesh, plc, options).findings) missed.insert(finding.guarantee);
  return {missed.begin(), missed.end()};
}

bool misses(const TetMesh& mesh, const Plc& plc, const std::string& guarantee) {
  const auto missed = guarantees_missed(mesh, plc);
  return std::ranges::count(missed, guarantee) > 0;
}

TEST(ShellCertificate, FindsFaultsOfTrianglesAndEdges) {
  const PolygonSoup soup = box();
  for (const unsigned order : {1U, 2U}) {
    Source source(soup);
    const SoupPipelineResult made = run_pipeline(source, asked(0.3, 2, order));
    const TetMesh& good = made.result.mesh;
    ASSERT_EQ(guarantees_missed(good, made.plc), std::vector<std::string>{});
    TetMesh twice = good;
    twice.edges.push_back(twice.edges[0]);
    twice.edge_curve.push_back(twice.edge_curve[0]);
    twice.edge_tag.push_back(twice.edge_tag[0]);
    if (order == 2) twice.edge_mid_nodes.push_back(twice.edge_mid_nodes[0]);
    EXPECT_TRUE(misses(twice, made.plc, "listed_edges"));
    TetMesh no_side = good;
    no_side.edges[0][1] = no_side.edges[no_side.edges.size() / 2][0];
    EXPECT_TRUE(misses(no_side, made.plc, "listed_edges"));
    TetMesh without = good;
    const Index gone = without.face_patch[0];
    for (std::size_t f = without.faces.size(); f-- > 0;) {
      if (without.face_patch[f] != gone) continue;
      without.faces.erase(without.faces.begin() + static_cast<long>(f));
      without.face_patch.erase(without.face_patch.begin() + static_cast<long>(f));
      without.face_tag.erase(without.face_tag.begin() + static_cast<long>(f));
      without.face_regions.erase(without.face_regions.begin() + static_cast<long>(f));
      if (order == 2) without.face_mid_nodes.erase(without.face_mid_nodes.begin() + static_cast<long>(f));
    }
    EXPECT_TRUE(misses(without, made.plc, "patch_present"));
    if (order == 1) {  // a node far from the middle of its triangles
      TetMesh sharp = good;
      const auto face = std::ranges::find_if(sharp.faces, [&](const auto& f) {
        return std::ranges::any_of(f, [&](Index v) { return sharp.features[v].dimension == 2; });
      });
      ASSERT_NE(face, sharp.faces.end());
      unsigned inner = 0;
      while (sharp.features[(*face)[inner]].dimension != 2) ++inner;
      Point& p = sharp.points[(*face)[inner]];
      p = p + 0.9 * (sharp.points[(*face)[(inner + 1) % 3]] - p);
      EXPECT_TRUE(misses(sharp, made.plc, "triangle_angles"));
    } else {  // a mid-edge node beyond the opposite corner
      TetMesh folded = good;
      const auto& [a, b, c] = folded.faces[0];
      folded.points[folded.face_mid_nodes[0][0]] = folded.points[c];
      EXPECT_TRUE(misses(folded, made.plc, "positive_jacobian"));
    }
  }
}

TEST(ShellCertificate, FindsLinesThatAreListedTwice) {
  const PolygonSoup soup = box();
  Source source(soup);
  const SoupPipelineResult made = run_pipeline(source, asked(0.3, 1));
  TetMesh twice = made.result.mesh;
  EXPECT_TRUE(check_lines(twice, made.plc).passed());
  twice.edges.push_back({twice.edges[0][1], twice.edges[0][0]});
  twice.edge_curve.push_back(twice.edge_curve[0]);
  twice.edge_tag.push_back(twice.edge_tag[0]);
  const CheckReport report = check_lines(twice, made.plc);
  EXPECT_TRUE(
      std::ranges::any_of(report.findings, [](const Finding& f) { return f.guarantee == "listed_edges"; }));
}

// Exact measures replace those of the complex; without a value those of the complex stay.
TEST(ShellCertificate, JudgesAreasByTheExactOnes) {
  const PolygonSoup soup = box();
  Source source(soup);
  const SoupPipelineResult made = run_pipeline(source, asked(0.3));
  CheckOptions options;
  options.exact = measures_of(made.plc);
  EXPECT_EQ(guarantees_missed(made.result.mesh, made.plc, options), std::vector<std::string>{});
  for (double& area : options.exact.areas) area = NAN;
  EXPECT_EQ(guarantees_missed(made.result.mesh, made.plc, options), std::vector<std::string>{});
  options.exact.areas[0] = 2;
  const CheckReport report = check_shells(made.result.mesh, made.plc, options);
  EXPECT_DOUBLE_EQ(report.of_input.areas[0], 2);
  EXPECT_NEAR(report.of_input.areas[1], 1, 1e-12);
}

}  // namespace
}  // namespace collarmesh::shell_sources_test
