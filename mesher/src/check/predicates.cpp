#include "check/predicates.h"

#include "mesh/orientation.h"

namespace collarmesh::checks {

bool check_orientation(const Named& tet, const std::array<Point, 4>& p, double volume, Findings& findings) {
  const int sign = exact_orientation(p[0], p[1], p[2], p[3]);
  if (sign > 0) return true;
  findings.add(
      guarantee::positive_volume, 0.25 * ((p[0] + p[1]) + (p[2] + p[3])), {tet.id},
      "{} with corners {}, {}, {}, {} {} (volume {:.6g}); a solver cannot use it. If the mesher made "
      "this mesh, report it with the input and the options.",
      tet, At{p[0]}, At{p[1]}, At{p[2]}, At{p[3]}, sign == 0 ? "is flat" : "is inverted", volume);
  return false;
}

void check_jacobian(const Named& tet, const CurvedTet& nodes, Tag tag, Findings& findings) {
  if (jacobian_exceeds(nodes)) return;
  const Point centre = 0.25 * ((nodes[0] + nodes[1]) + (nodes[2] + nodes[3]));
  findings.add(
      guarantee::positive_jacobian, centre, {tet.id},
      "{} of tag {} at {} is of second order and its Jacobian determinant is not positive everywhere "
      "in it; a solver cannot use it: put its mid-edge nodes nearer to the middles of its edges.",
      tet, tag, At{centre});
}

void check_off_feature(std::string_view guarantee, const Named& node, const Point& at, double distance,
                       double allowed, const NamedFeature& feature, Findings& findings) {
  if (distance <= allowed) return;
  findings.add(guarantee, at, {node.id, feature.id},
               "{} at {} is {:.6g} away from its {} {} (tag {}), allowed is {:.6g}; move the node onto it.",
               node, At{at}, distance, feature.kind, feature.id, feature.tag, allowed);
}

}  // namespace collarmesh::checks
