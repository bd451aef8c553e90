// Patches that are cut open, by brute force: sectors around nodes, also in random networks of fractures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "check/split.h"
#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/split.h"
#include "support/plc_shapes.h"

namespace collarmesh::split_test {
namespace {

using namespace testing;

using Corners = std::array<Index, 3>;
constexpr std::array<std::array<unsigned, 2>, 6> edges_of_tet{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

PolygonSoup quad(const std::array<Point, 4>& corners, Tag tag) {
  PolygonSoup soup;
  soup.points.assign(corners.begin(), corners.end());
  soup.add_facet(std::array<Index, 4>{0, 1, 2, 3}, tag);
  return soup;
}

/// The unit cube with sheets; sheet k has the tag 100 + k.
std::vector<PolygonSoup> cube_with(const std::vector<std::array<Point, 4>>& sheets) {
  std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1})};
  for (std::size_t k = 0; k < sheets.size(); ++k) soups.push_back(quad(sheets[k], static_cast<Tag>(100 + k)));
  return soups;
}

PipelineResult mesh_of_soups(const std::vector<PolygonSoup>& soups, double size, unsigned order,
                             const SplitOptions& split = {}) {
  PipelineOptions options;
  options.mesh.size = size;
  options.mesh.max_vertices = 200'000;
  options.order = order;
  options.split = split;
  return run_pipeline(soups, options);
}

/// Returns the number of nodes that a place should have, by flooding the tets there: two tets with a common
/// triangle at the place are connected unless the triangle is split. Tets that met without a common triangle
/// count as connected.
std::size_t nodes_wanted(const TetMesh& mesh, const std::vector<Index>& tets, const std::set<Index>& at,
                         const std::set<Corners>& open) {
  const auto pieces = [&](bool cut) {
    std::vector<bool> seen(tets.size(), false);
    std::size_t count = 0;
    for (std::size_t first = 0; first < tets.size(); ++first) {
      if (seen[first]) continue;
      ++count;
      std::vector<std::size_t> next{first};
      seen[first] = true;
      while (!next.empty()) {
        const std::size_t i = next.back();
        next.pop_back();
        for (std::size_t j = 0; j < tets.size(); ++j) {
          if (seen[j]) continue;
          std::vector<Index> common;
          for (const Index v : mesh.tets[tets[i]])
            if (std::ranges::count(mesh.tets[tets[j]], v) > 0) common.push_back(v);
          if (common.size() != 3) continue;
          const Corners side = sorted({common[0], common[1], common[2]});
          if (!std::ranges::all_of(at, [&](Index v) { return std::ranges::count(side, v) > 0; })) continue;
          if (cut && open.contains(side)) continue;
          seen[j] = true;
          next.push_back(j);
        }
      }
    }
    return count;
  };
  return pieces(true) - pieces(false) + 1;
}

/// Compares the number of nodes at each place, corners and mid-edge nodes, with the expected one.
void expect_nodes_of_sectors(const TetMesh& before, const TetMesh& after, const std::set<Corners>& open) {
  std::map<Index, std::vector<Index>> tets_at;
  std::map<Index, std::set<Index>> ends_of, found;
  for (Index t = 0; t < before.tets.size(); ++t) {
    for (unsigned k = 0; k < 4; ++k) {
      const Index v = before.tets[t][k];
      tets_at[v].push_back(t);
      ends_of[v] = {v};
      found[v].insert(after.tets[t][k]);
    }
    for (unsigned k = 0; k < 6 && before.order() == 2; ++k) {
      const Index v = before.tet_mid_nodes[t][k];
      tets_at[v].push_back(t);
      ends_of[v] = {before.tets[t][edges_of_tet[k][0]], before.tets[t][edges_of_tet[k][1]]};
      found[v].insert(after.tet_mid_nodes[t][k]);
    }
  }
  std::size_t nodes = 0;
  for (const auto& [v, tets] : tets_at) {
    EXPECT_EQ(found[v].size(), nodes_wanted(before, tets, ends_of[v], open)) << "at node " << v;
    for (const Index copy : found[v]) EXPECT_EQ(after.points[copy], before.points[v]);
    nodes += found[v].size();
  }
  EXPECT_EQ(nodes, after.points.size());
}

/// Splits patches of a mesh and judges it by brute force and by the certificate.
SplitReport expect_right_split(TetMesh mesh, const SplitOptions& options) {
  const TetMesh before = mesh;
  const checks::SplitMeasures measures = checks::measure_before_split(before);
  SplitReport report = split(mesh, options);
  std::set<Tag> sides;
  for (const Sides& each : report.interfaces.sides) sides.insert({each.minus, each.plus});
  std::set<Corners> open;  // in node numbers before the split, as faces keep their places
  for (Index f = 0; f < before.faces.size(); ++f)
    if (before.face_regions[f][1] != 0 && mesh.face_regions[f][1] == 0) open.insert(sorted(before.faces[f]));
  EXPECT_EQ(mesh.faces.size(), before.faces.size() + open.size());
  expect_nodes_of_sectors(before, mesh, open);
  CheckReport check;
  checks::check_split(mesh, report.interfaces.sides, measures, check);
  for (const Finding& finding : check.findings) ADD_FAILURE() << finding.guarantee << ": " << finding.message;
  return report;
}

TEST(Split, ACrackInsideKeepsItsFrontClosed) {
  const auto soups = cube_with({{{{0.3, 0.3, 0.5}, {0.7, 0.3, 0.5}, {0.7, 0.7, 0.5}, {0.3, 0.7, 0.5}}}});
  for (const unsigned order : {1U, 2U}) {
    const PipelineResult made = mesh_of_soups(soups, 0.1, order);
    ASSERT_TRUE(made.guarantees_hold()) << made.missed();
    const SplitReport report = expect_right_split(made.result.mesh, {.patches = {"100"}});
    ASSERT_EQ(report.patches.size(), 1U);
    EXPECT_NEAR(report.patches[0].area, 0.16, 0.03) << "corners may stay closed";
    EXPECT_GT(report.front_nodes, 4U);
    EXPECT_GT(report.split_nodes, 0U);
    EXPECT_EQ(report.junction_nodes, 0U);
  }
}

TEST(Split, AMouthOnTheBoundaryOpens) {
  const auto soups = cube_with({{{{0, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0, 1, 0.5}}}});
  const PipelineResult made = mesh_of_soups(soups, 0.2, 1);
  ASSERT_TRUE(made.guarantees_hold()) << made.missed();
  TetMesh mesh = made.result.mesh;
  split(mesh, {.patches = {"patch_100"}});
  std::size_t at_corner = 0, on_front = 0;
  for (const Point& p : mesh.points) {
    at_corner += p == Point{0, 0, 0.5} ? 1 : 0;
    on_front += p == Point{0.5, 0, 0.5} ? 1 : 0;
  }
  EXPECT_EQ(at_corner, 2U);
  EXPECT_EQ(on_front, 1U);
}

TEST(Split, SheetsThatCrossHaveANodeForEachSector) {
  const auto soups = cube_with({{{{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}}},
                                {{{0.5, 0, 0}, {0.5, 0, 1}, {0.5, 1, 1}, {0.5, 1, 0}}}});
  for (const unsigned order : {1U, 2U}) {
    const PipelineResult made = mesh_of_soups(soups, 0.25, order);
    ASSERT_TRUE(made.guarantees_hold()) << made.missed();
    const SplitReport report =
        expect_right_split(made.result.mesh, {.patches = {"100", "101"}, .keep_apart = false});
    EXPECT_GT(report.junction_nodes, 4U);
    EXPECT_EQ(report.front_nodes, 0U);
  }
}

TEST(Split, BlocksAreKeptApart) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1}),
                                       polygonal_box({0, 0, 1}, {1, 1, 2})};
  for (const unsigned order : {1U, 2U}) {
    const PipelineResult made = mesh_of_soups(soups, 0.4, order, {.keep_apart = true, .cohesive = true});
    ASSERT_TRUE(made.guarantees_hold()) << made.missed();
    ASSERT_TRUE(made.split);
    EXPECT_EQ(made.split->patches.size(), 2U);
    EXPECT_GT(made.split->junction_nodes, 0U) << "the first block's edge meets both others";
    const TetMesh& mesh = made.result.mesh;
    std::map<Index, Index> region_of;  // by node
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const Index v : mesh.tets[t])
        EXPECT_EQ(region_of.try_emplace(v, mesh.tet_region[t]).first->second, mesh.tet_region[t]);
    const Interfaces& between = made.split->interfaces;
    EXPECT_EQ(between.prisms.size(), made.split->patches[0].faces + made.split->patches[1].faces);
    EXPECT_EQ(between.prism_mid_nodes.size(), order == 2 ? between.prisms.size() : 0U);
    for (const auto& prism : between.prisms)
      for (unsigned k = 0; k < 3; ++k) EXPECT_EQ(mesh.points[prism[k]], mesh.points[prism[k + 3]]);
    for (const auto& middle : between.prism_mid_nodes)
      for (unsigned k = 0; k < 3; ++k) EXPECT_EQ(mesh.points[middle[k]], mesh.points[middle[k + 3]]);
    expect_right_split(mesh_of_soups(soups, 0.4, order).result.mesh, {.keep_apart = true});
  }
}

/// The minus side's triangles and prisms point towards the plus side.
TEST(Split, SidesAndPrismsAreOriented) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  const PipelineResult made = mesh_of_soups(soups, 0.5, 1, {.keep_apart = true, .cohesive = true});
  ASSERT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  const auto normal = [&](const auto& corners) {
    return cross(mesh.points[corners[1]] - mesh.points[corners[0]],
                 mesh.points[corners[2]] - mesh.points[corners[0]]);
  };
  const Sides sides = made.split->interfaces.sides.at(0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const double x = normal(mesh.faces[f]).x;
    EXPECT_TRUE(mesh.face_tag[f] != sides.minus || x > 0);
    EXPECT_TRUE(mesh.face_tag[f] != sides.plus || x < 0);
    EXPECT_EQ(mesh.face_regions[f][1], 0U);
  }
  for (const auto& prism : made.split->interfaces.prisms) EXPECT_GT(normal(prism).x, 0);
  EXPECT_EQ(*mesh.names.find(2, sides.minus), made.split->patches[0].name + "_minus");
  EXPECT_EQ(*mesh.names.find(2, sides.plus), made.split->patches[0].name + "_plus");
}

class FractureNetworks : public ::testing::TestWithParam<unsigned> {};

TEST_P(FractureNetworks, HaveTheNodesOfTheirSectors) {
  std::mt19937_64 random(GetParam());
  std::uniform_real_distribution<double> place(0.15, 0.85);
  std::vector<std::array<Point, 4>> sheets;
  for (unsigned k = 0; k < 2 + GetParam() % 3; ++k) {
    const unsigned axis = k % 3;
    const double at = place(random), low = 0, high = place(random);
    const auto corner = [&](double u, double v) {
      Point p;
      (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = at;
      (axis == 0 ? p.y : p.x) = u;
      (axis == 2 ? p.y : p.z) = v;
      return p;
    };
    sheets.push_back({corner(low, low), corner(high, low), corner(high, 0.95), corner(low, 0.95)});
  }
  const PipelineResult made = mesh_of_soups(cube_with(sheets), 0.3, 1 + GetParam() % 2);
  ASSERT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  std::set<Tag> inside;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_regions[f][1] != 0) inside.insert(mesh.face_tag[f]);
  ASSERT_FALSE(inside.empty());
  SplitOptions options;
  for (const Tag tag : inside) options.patches.push_back(std::to_string(tag));
  expect_right_split(mesh, options);
}

INSTANTIATE_TEST_SUITE_P(Random, FractureNetworks, ::testing::Range(0U, 30U));

TEST(Split, NamesThatAreNotThereAreErrors) {
  const auto soups = cube_with({{{{0.3, 0.3, 0.5}, {0.7, 0.3, 0.5}, {0.7, 0.7, 0.5}, {0.3, 0.7, 0.5}}}});
  const auto message = [&](const SplitOptions& options) {
    try {
      mesh_of_soups(soups, 0.3, 1, options);
    } catch (const OptionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({.patches = {"crack"}}).find("no patch is called 'crack'"), std::string::npos);
  EXPECT_NE(message({.patches = {"crack"}}).find("can be split: 100"), std::string::npos);
  const TetMesh mesh = mesh_of_soups(soups, 0.3, 1).result.mesh;
  const auto outer = std::ranges::find_if(mesh.face_regions, [](const auto& each) { return each[1] == 0; });
  ASSERT_NE(outer, mesh.face_regions.end());
  const std::string side =
      std::to_string(mesh.face_tag[static_cast<std::size_t>(outer - mesh.face_regions.begin())]);
  EXPECT_NE(message({.patches = {side}}).find("'" + side + "' lies on the boundary"), std::string::npos);
  EXPECT_NE(message({.keep_apart = true}).find("no two regions touch"), std::string::npos);
  EXPECT_NE(message({.cohesive = true}).find("add split or keep-apart"), std::string::npos);
}

TEST(SplitCertificate, FindsWrongSplits) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  const TetMesh before = mesh_of_soups(soups, 0.4, 1).result.mesh;
  const checks::SplitMeasures measures = checks::measure_before_split(before);
  TetMesh mesh = before;
  const std::vector<Sides> sides = split(mesh, {.keep_apart = true}).interfaces.sides;
  const auto first = [&](const TetMesh& wrong) {
    CheckReport check;
    checks::check_split(wrong, sides, measures, check);
    return check.findings.empty() ? std::string() : check.findings.front().guarantee;
  };
  EXPECT_EQ(first(mesh), "");
  TetMesh moved = mesh;
  moved.points.back().x += 0.01;
  EXPECT_NE(first(moved), "");
  TetMesh glued = mesh;  // glues the sides at one node
  const auto copy = static_cast<Index>(mesh.points.size() - 1);
  const auto original = static_cast<Index>(
      std::find(mesh.points.begin(), mesh.points.end(), mesh.points[copy]) - mesh.points.begin());
  for (auto& tet : glued.tets) std::replace(tet.begin(), tet.end(), copy, original);
  for (auto& face : glued.faces) std::replace(face.begin(), face.end(), copy, original);
  EXPECT_NE(first(glued), "");
  TetMesh turned = mesh;
  std::swap(turned.faces.back()[0], turned.faces.back()[1]);
  EXPECT_EQ(first(turned), "split_pairs");
}

}  // namespace
}  // namespace collarmesh::split_test
