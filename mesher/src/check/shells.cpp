// The certificate of a mesh of triangles alone. The guarantees for faces of a mesh of tets hold here, too; in
// addition, the triangles are judged as elements.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "check/feature_sizes.h"
#include "check/mesh_to_check.h"
#include "check/shell_orientation.h"
#include "common/edge_key.h"
#include "common/thread_limit.h"

namespace collarmesh {

namespace checks {

namespace {

struct Angles {
  std::array<double, 3> at;  // degrees
  double least() const { return *std::min_element(at.begin(), at.end()); }
  double largest() const { return *std::max_element(at.begin(), at.end()); }
};

double angle_between(const Vector& u, const Vector& v) {
  return std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
}

Angles angles_of(const MeshToCheck& to_check, Index face) {
  Angles angles{};
  const auto& f = to_check.mesh.faces[face];
  for (unsigned i = 0; i < 3; ++i) {
    const Point& p = to_check.point(f[i]);
    angles.at[i] = angle_between(to_check.point(f[(i + 1) % 3]) - p, to_check.point(f[(i + 2) % 3]) - p);
  }
  return angles;
}

/// The edges of curves and the vertices of the complex, as found in the mesh.
class GivenCorners {
 public:
  explicit GivenCorners(const MeshToCheck& to_check) : is_vertex_(to_check.mesh.points.size(), false) {
    for (const Index p : to_check.match.vertex_point)
      if (p != none) is_vertex_[p] = true;
    for (const auto& [a, b] : to_check.mesh.edges) edges_.push_back(edge_key(a, b));
    std::sort(edges_.begin(), edges_.end());
  }

  bool is_edge(Index a, Index b) const {
    return std::binary_search(edges_.begin(), edges_.end(), edge_key(a, b));
  }
  /// Returns whether a corner of a face is a vertex of the complex and both sides there lie on curves.
  bool is_corner(const std::array<Index, 3>& face, unsigned i) const {
    return is_vertex_[face[i]] && is_edge(face[i], face[(i + 1) % 3]) && is_edge(face[i], face[(i + 2) % 3]);
  }

 private:
  std::vector<bool> is_vertex_;
  std::vector<std::uint64_t> edges_;
};

void check_angles(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  const GivenCorners given(to_check);
  TriangleMeasures measures;
  measures.triangles = to_check.mesh.faces.size();
  const auto bin = [](double angle) {
    constexpr double width = 180.0 / TriangleMeasures::bins;
    return std::min(TriangleMeasures::bins - 1, static_cast<std::size_t>(angle / width));
  };
  for (Index f = 0; f < to_check.mesh.faces.size(); ++f) {
    const auto& face = to_check.mesh.faces[f];
    const Angles angles = angles_of(to_check, f);
    measures.min_angle = std::min(measures.min_angle, angles.least());
    measures.max_angle = std::max(measures.max_angle, angles.largest());
    ++measures.min_angles[bin(angles.least())];
    ++measures.max_angles[bin(angles.largest())];
    if (angles.least() >= least_triangle_angle && angles.largest() <= largest_triangle_angle) continue;
    double least = least_triangle_angle;
    for (unsigned i = 0; i < 3; ++i)
      if (given.is_corner(face, i)) least = std::min(least, angles.at[i] / 2);
    const double largest =
        least < least_triangle_angle ? 180 - 3 * least : largest_triangle_angle;  // the given corner has 2 *
                                                                                  // least, another at least
                                                                                  // least, and the sum is 180
    if (angles.least() >= least && angles.largest() <= largest) {
      ++measures.at_sharp_corners;
      continue;
    }
    const Point where = to_check.centroid(face);
    findings.add(
        guarantee::triangle_angles, where, {f},
        "Triangle {} at {} has angles from {:.4g} to {:.4g} degrees, allowed are {:.4g} to {:.4g}; features "
        "of the input are close to each other there: choose a smaller size there, or remove them.",
        f, At{where}, angles.least(), angles.largest(), least, largest);
  }
  report.triangles = measures;
}

/// Checks that listed edges are sides of faces, each listed once.
void check_edges(const MeshToCheck& to_check, Findings& findings) {
  std::vector<std::uint64_t> sides;
  for (const auto& f : to_check.mesh.faces)
    for (unsigned i = 0; i < 3; ++i) sides.push_back(edge_key(f[i], f[(i + 1) % 3]));
  std::sort(sides.begin(), sides.end());
  std::vector<std::uint64_t> listed;
  for (const auto& [a, b] : to_check.mesh.edges) listed.push_back(edge_key(a, b));
  std::sort(listed.begin(), listed.end());
  for (Index e = 0; e < to_check.mesh.edges.size(); ++e) {
    const std::uint64_t number = edge_key(to_check.mesh.edges[e][0], to_check.mesh.edges[e][1]);
    const Point where = to_check.midpoint(to_check.mesh.edges[e]);
    if (!std::binary_search(sides.begin(), sides.end(), number))
      findings.add(guarantee::listed_edges, where, {e}, "Edge {} at {} is a side of no triangle.", e,
                   At{where});
    const auto [first, last] = std::equal_range(listed.begin(), listed.end(), number);
    if (last - first > 1)
      findings.add(guarantee::listed_edges, where, {e}, "Edge {} at {} is listed {} times.", e, At{where},
                   last - first);
  }
}

/// Returns the normal of a curved triangle at parameters (s, t); its length is the Jacobian.
Vector jacobian_at(const CurvedTriangle& n, double s, double t) {
  const double r = 1 - s - t;
  const Vector ds =
                   (1 - 4 * r) * n[0] + (4 * s - 1) * n[1] + 4 * (r - s) * n[3] + 4 * t * n[4] - 4 * t * n[5],
               dt =
                   (1 - 4 * r) * n[0] + (4 * t - 1) * n[2] - 4 * s * n[3] + 4 * s * n[4] + 4 * (r - t) * n[5];
  return cross(ds, dt);
}

/// Returns whether bounds prove that the Jacobian is positive everywhere. The normal's component along the
/// normal of the straight triangle is a polynomial of degree 2; its coefficients in Bernstein's basis bound
/// it from below. They follow from its values at the corners and at the middles of the sides.
bool jacobian_is_positive(const CurvedTriangle& n) {
  const Vector normal = cross(n[1] - n[0], n[2] - n[0]);
  const auto value = [&](double s, double t) { return dot(jacobian_at(n, s, t), normal); };
  const std::array<double, 3> corners{value(0, 0), value(1, 0), value(0, 1)};
  const std::array<double, 3> middles{value(0.5, 0), value(0.5, 0.5), value(0, 0.5)};
  for (unsigned i = 0; i < 3; ++i) {
    const double between = 2 * middles[i] - 0.5 * (corners[i] + corners[(i + 1) % 3]);
    if (!(corners[i] > 0) || !(between > 0)) return false;
  }
  return true;
}

void check_triangle_jacobians(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  if (mesh.order() == 1) return;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (jacobian_is_positive(curved_face(mesh, f))) continue;
    const Point where = to_check.centroid(mesh.faces[f]);
    findings.add(guarantee::positive_jacobian, where, {f},
                 "Triangle {} of tag {} at {} is of second order and folds: its Jacobian is not positive "
                 "everywhere; put its mid-edge nodes nearer to the middles of its edges.",
                 f, mesh.face_tag[f], At{where});
  }
}

/// Removes the regions: here they must not influence how faces are compared with patches.
void forget_regions(TetMesh& mesh, Plc& plc) {
  for (Plc::Patch& patch : plc.patches) patch.regions = {0, 0};
  mesh.face_regions.assign(mesh.faces.size(), {0, 0});
}

void judge_shells(const TetMesh& given, const Plc& given_plc, const CheckOptions& options,
                  CheckReport& report, const Execution& execution) {
  Findings findings(report, options.findings_per_guarantee);
  if (!check_arrays(given, findings)) return;
  TetMesh mesh = given;
  Plc plc = given_plc;
  forget_regions(mesh, plc);
  // Compute the tolerance from the complex that still has its regions: it depends on them.
  CheckOptions own = options;
  own.bounds.tolerance = tolerance_of_any_size(given_plc, options.bounds);
  MeshToCheck to_check = make_mesh_to_check(mesh, plc, own);
  if (!check_points(to_check, findings) || !check_labels(mesh, plc, findings)) return;
  to_check.match = match_features(mesh, plc, to_check.rounding);
  check_present(to_check, 2, findings);
  check_vertices(to_check, findings);
  check_edges(to_check, findings);
  check_angles(to_check, report, findings);
  if ((report.cancelled = execution.cancelled())) return;
  check_curves(to_check, report, findings);
  check_patches(to_check, report, findings);
  if ((report.cancelled = execution.cancelled())) return;
  check_shell_orientation(to_check, given_plc, findings);
  check_second_order(to_check, report, findings);
  check_triangle_jacobians(to_check, findings);
  measure_without_tets(to_check, 2, report);
}

}  // namespace

}  // namespace checks

CheckReport check_shells(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                         const Execution& execution) {
  CheckReport report;
  report.points = mesh.points.size();
  report.faces = mesh.faces.size();
  report.edges = mesh.edges.size();
  ThreadLimit(options.threads).run([&] { checks::judge_shells(mesh, plc, options, report, execution); });
  return report;
}

}  // namespace collarmesh
