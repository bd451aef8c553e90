#include <algorithm>
#include <cmath>

#include "check/mesh_to_check.h"
#include "check/polyline.h"

namespace collarmesh::checks {

namespace {

double flat_allowance(double deviation, const MeshToCheck& to_check) {
  return std::min(4 * deviation, to_check.plc.planar_tolerance) + to_check.rounding;
}

}  // namespace

std::vector<double> curve_allowances(const MeshToCheck& to_check) {
  const Plc& plc = to_check.plc;
  std::vector<double> allowances;
  for (const Plc::Curve& curve : plc.curves) {
    double deviation = 0;
    if (curve.straight)
      for (const Index i : curve.points)
        deviation = std::max(deviation, nearest_on_segment(plc.points[i], plc.points[curve.points.front()],
                                                           plc.points[curve.points.back()])
                                            .distance);
    allowances.push_back(curve.straight ? flat_allowance(deviation, to_check)
                                        : to_check.tolerance.largest_on_curve(curve) + to_check.rounding);
  }
  return allowances;
}

std::vector<double> patch_allowances(const MeshToCheck& to_check) {
  const Plc& plc = to_check.plc;
  std::vector<double> deviations(plc.patches.size(), 0), allowances;
  for (const Plc::Triangle& t : plc.triangles) {
    const Plc::Patch& patch = plc.patches[t.patch];
    for (const Index i : t.points)
      deviations[t.patch] =
          std::max(deviations[t.patch], std::fabs(dot(plc.points[i] - patch.origin, patch.normal)));
  }
  for (Index p = 0; p < plc.patches.size(); ++p)
    allowances.push_back(plc.patches[p].planar ? flat_allowance(deviations[p], to_check)
                                               : to_check.tolerance.largest_on_patch(p) + to_check.rounding);
  return allowances;
}

}  // namespace collarmesh::checks
