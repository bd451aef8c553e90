// Faults that the certificate finds in meshes that no stage makes: splits elsewhere than asked, maps that are
// not unique, curved cells of layers, and faces of no tet.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "check/layer_cells.h"
#include "check/periodic.h"
#include "check/split.h"
#include "collarmesh/check.h"
#include "collarmesh/split.h"
#include "support/layer_mesh.h"
#include "support/meshes.h"
#include "support/periodic.h"
#include "support/second_order.h"

namespace collarmesh::check_rare_faults_test {
namespace {

using namespace testing;

std::size_t count(const CheckReport& report, const std::string& guarantee, const std::string& part) {
  return static_cast<std::size_t>(std::ranges::count_if(report.findings, [&](const Finding& finding) {
    return finding.guarantee == guarantee && finding.message.find(part) != std::string::npos;
  }));
}

TEST(CheckRareFaults, PatchesThatAreCutOpenWithoutBeingAsked) {
  TetMesh mesh = meshed_two_boxes(2).mesh;
  const checks::SplitMeasures before = checks::measure_before_split(mesh);
  const SplitReport split_of = split(mesh, {.keep_apart = true});
  CheckReport good, none_asked;
  checks::check_split(mesh, split_of.interfaces.sides, before, good);
  EXPECT_TRUE(good.passed());
  checks::check_split(mesh, {}, before, none_asked);
  EXPECT_EQ(count(none_asked, "split_nodes", "is on no triangle of a split patch"), 2U * 9) << "both copies";
  EXPECT_EQ(count(none_asked, "split_pairs", "cut open but no triangle of a split patch"), 8U);
}

TEST(CheckRareFaults, NodesWithTwoImages) {
  MeshedComplex box = meshed_box(2);
  make_box_periodic(box.mesh, {1, 1, 1});
  CheckReport good, twice;
  checks::check_periodic(box.mesh, good);
  EXPECT_TRUE(good.passed());
  auto& nodes = box.mesh.periodic[0].nodes;
  nodes.insert(nodes.begin(), nodes.front());
  checks::check_periodic(box.mesh, twice);
  EXPECT_EQ(count(twice, "periodic_nodes", "twice"), 1U);
}

TEST(CheckRareFaults, FacesAndEdgesThatBelongToNoTet) {
  MeshedComplex box = meshed_box(2);
  ASSERT_TRUE(check(box.mesh, box.plc, {.bounds = {.radius_edge = 10}}).passed());
  const auto corner = [&](const Point& p) {
    return static_cast<Index>(std::ranges::find(box.mesh.points, p) - box.mesh.points.begin());
  };
  box.mesh.faces.push_back({corner({0, 0, 0}), corner({1, 0, 0}), corner({0, 1, 0})});
  box.mesh.face_regions.push_back(box.mesh.face_regions[0]);
  box.mesh.face_patch.push_back(box.mesh.face_patch[0]);
  box.mesh.face_tag.push_back(box.mesh.face_tag[0]);
  const CheckReport report = check(box.mesh, box.plc, {.bounds = {.radius_edge = 10}});
  EXPECT_EQ(count(report, "listed_faces", "is a side of no tet"), 1U);
}

TEST(CheckRareFaults, CurvedCellsOfLayersThatFoldOrShareNodes) {
  const TetMesh good = second_order(LayerMesh().make());
  CheckReport right;
  checks::check_layer_cells(good, right);
  ASSERT_TRUE(right.passed());
  TetMesh folded = good;
  folded.points[folded.tet_mid_nodes[0][0]] =
      folded.points[folded.tets[0][0]] +
      3 * (folded.points[folded.tets[0][1]] - folded.points[folded.tets[0][0]]);
  CheckReport fold;
  checks::check_layer_cells(folded, fold);
  EXPECT_GE(count(fold, "layer_jacobian", "Jacobian of the curved tet"), 1U);
  TetMesh shared = good;
  shared.tet_mid_nodes[0][0] = shared.tet_mid_nodes[0][1];
  CheckReport share;
  checks::check_layer_cells(shared, share);
  EXPECT_GE(count(share, "layer_mid_nodes", "is the mid-edge node of two edges"), 1U);
}

}  // namespace
}  // namespace collarmesh::check_rare_faults_test
