// The certificate: each guarantee recomputed from the mesh and the complex alone.
#include "collarmesh/check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/subject.h"

namespace collarmesh {

namespace {

using namespace checks;

Box bounds_of(const Plc& plc) {
  if (!plc.bounds.empty()) return plc.bounds;
  Box box;
  for (const Point& p : plc.points) box.add(p);
  return box;
}

double largest_coordinate(const Box& box) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
  return largest;
}

Subject make_subject(const TetMesh& mesh, const Plc& plc, const CheckOptions& options) {
  constexpr double epsilon = 0x1p-52;
  const Box box = bounds_of(plc);
  Subject subject{mesh,
                  plc,
                  options,
                  1e-12 * box.diagonal() + 8 * epsilon * largest_coordinate(box),
                  {},
                  {},
                  std::make_shared<RegionLocator>(plc),
                  {},
                  {}};
  if (!(subject.options.distance > 0)) subject.options.distance = 1e-3 * box.diagonal();
  subject.curve_allowance = curve_allowances(subject);
  subject.patch_allowance = patch_allowances(subject);
  return subject;
}

void judge(Subject subject, CheckReport& report, Findings& findings) {
  report.faces = subject.mesh.faces.size();
  report.edges = subject.mesh.edges.size();
  subject.match = match_features(subject.mesh, subject.plc, subject.rounding);
  subject.collar = collar_cells(subject, findings);
  check_tets(subject, report, findings);
  check_conformity(subject, findings);
  check_watertight(subject, findings);
  check_region_volumes(subject, report, findings);
  check_vertices(subject, findings);
  check_listed_edges(subject, findings);
  check_curves(subject, report, findings);
  check_patches(subject, report, findings);
  check_collars(subject, findings);
  check_second_order(subject, report, findings);
}

}  // namespace

CheckReport check(const TetMesh& mesh, const Plc& plc, const CheckOptions& options) {
  CheckReport report;
  Findings findings(report, options.findings_per_guarantee);
  report.tets = mesh.tets.size();
  report.points = mesh.points.size();
  report.faces = mesh.faces.size();
  report.edges = mesh.edges.size();
  if (!check_arrays(mesh, findings)) return report;
  Subject given = make_subject(mesh, plc, options);
  if (!check_points(given, findings)) return report;
  const std::size_t before = findings.total();
  const std::optional<TetMesh> placed = place_by_position(given, report, findings);
  if (findings.total() > before || !check_labels(placed ? *placed : mesh, plc, findings)) return report;
  if (placed)
    judge(make_subject(*placed, plc, options), report, findings);
  else
    judge(std::move(given), report, findings);
  return report;
}

}  // namespace collarmesh
