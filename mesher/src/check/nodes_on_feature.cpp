#include "check/nodes_on_feature.h"

#include <algorithm>
#include <cmath>

#include "common/segments.h"

namespace collarmesh::checks {

namespace {

DistanceTree pieces_of(const MeshToCheck& to_check, const TetMesh::VertexFeature& feature) {
  const Plc& plc = to_check.plc;
  std::vector<DistanceTree::Triangle> pieces;
  if (feature.dimension == 1) {
    visit_segments(plc.curves[feature.feature], [&](Index a, Index b) {
      pieces.push_back({plc.points[a], plc.points[b], plc.points[b]});
    });
  } else if (const Plc::Patch& patch = plc.patches[feature.feature]; !patch.planar) {
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
      pieces.push_back({to_check.plc_corner(plc.triangles[t], 0), to_check.plc_corner(plc.triangles[t], 1),
                        to_check.plc_corner(plc.triangles[t], 2)});
  }
  return DistanceTree(std::move(pieces));
}

}  // namespace

NodesOnFeature::NodesOnFeature(const MeshToCheck& to_check, const TetMesh::VertexFeature& feature)
    : to_check_(to_check), feature_(feature), pieces_(pieces_of(to_check, feature)) {}

void NodesOnFeature::check(std::string_view guarantee, const Named& node, const Point& at, double& largest,
                           Findings& findings) const {
  const auto judge = [&](const NamedFeature& name, double distance, double allowed, bool smooth) {
    if (smooth) largest = std::max(largest, distance);
    check_off_feature(guarantee, node, at, distance, allowed, name, findings);
  };
  const Index i = feature_.feature;
  if (feature_.dimension == 1) {
    const Plc::Curve& curve = to_check_.plc.curves[i];
    judge({"curve", i, curve.tag}, pieces_.nearest(at).distance, to_check_.curve_allowance[i],
          !curve.straight);
  } else {
    const Plc::Patch& patch = to_check_.plc.patches[i];
    judge({"patch", i, patch.tag},
          patch.planar ? std::fabs(dot(at - patch.origin, patch.normal)) : pieces_.nearest(at).distance,
          to_check_.patch_allowance[i], !patch.planar);
  }
}

}  // namespace collarmesh::checks
