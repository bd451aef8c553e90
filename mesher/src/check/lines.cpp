// The certificate of a mesh of curve edges alone.
#include <algorithm>
#include <vector>

#include "check/feature_sizes.h"
#include "check/mesh_to_check.h"
#include "common/thread_limit.h"

namespace collarmesh {

namespace checks {

namespace {

void check_listed_once(const MeshToCheck& to_check, Findings& findings) {
  std::vector<std::array<Index, 2>> listed;
  for (const auto& [a, b] : to_check.mesh.edges) listed.push_back(sorted(a, b));
  std::sort(listed.begin(), listed.end());
  for (std::size_t i = 1; i < listed.size(); ++i) {
    if (listed[i] != listed[i - 1]) continue;
    const Point where = to_check.midpoint(listed[i]);
    findings.add(guarantee::listed_edges, where, {listed[i][0], listed[i][1]},
                 "The edge of points {} and {} at {} is listed twice.", listed[i][0], listed[i][1],
                 At{where});
  }
}

/// Checks edges of second order. The tangent is linear in the edge's parameter, so its component along the
/// chord is positive everywhere if it is positive at both ends.
void check_edge_jacobians(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  if (mesh.order() == 1) return;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const Point &a = mesh.points[mesh.edges[e][0]], &b = mesh.points[mesh.edges[e][1]],
                &m = mesh.points[mesh.edge_mid_nodes[e]];
    const Vector chord = b - a;
    if (dot(4 * (m - a) - chord, chord) > 0 && dot(4 * (b - m) - chord, chord) > 0) continue;
    findings.add(guarantee::positive_jacobian, m, {e},
                 "Edge {} with tag {} at {} is of second order and folds back on itself; put its mid-edge "
                 "node nearer to its middle.",
                 e, mesh.edge_tag[e], At{m});
  }
}

void judge_lines(const TetMesh& mesh, const Plc& given, const CheckOptions& options, CheckReport& report) {
  Findings findings(report, options.findings_per_guarantee);
  if (!check_arrays(mesh, findings)) return;
  Plc plc = given;  // regions and patches do not matter here
  for (Plc::Patch& patch : plc.patches) patch.regions = {0, 0};
  CheckOptions own = options;
  own.bounds.tolerance = tolerance_of_any_size(given, options.bounds);
  MeshToCheck to_check = make_mesh_to_check(mesh, plc, own);
  if (!check_points(to_check, findings) || !check_labels(mesh, plc, findings)) return;
  to_check.match = match_features(mesh, plc, to_check.rounding);
  check_present(to_check, 1, findings);
  check_vertices(to_check, findings);
  check_listed_once(to_check, findings);
  check_curves(to_check, report, findings);
  check_second_order(to_check, report, findings);
  check_edge_jacobians(to_check, findings);
  measure_without_tets(to_check, 1, report);
}

}  // namespace

}  // namespace checks

CheckReport check_lines(const TetMesh& mesh, const Plc& plc, const CheckOptions& options) {
  CheckReport report;
  report.points = mesh.points.size();
  report.edges = mesh.edges.size();
  ThreadLimit(options.threads).run([&] { checks::judge_lines(mesh, plc, options, report); });
  return report;
}

}  // namespace collarmesh
