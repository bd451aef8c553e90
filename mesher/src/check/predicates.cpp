#include "check/predicates.h"

#include <cmath>

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
               "{} at {} is {:.6g} away from its {}, allowed is {:.6g}; move the node onto it.", node, At{at},
               distance, feature, allowed);
}

bool check_edges_at(const NamedFeature& curve, const Point& at, std::ptrdiff_t edges, std::ptrdiff_t wanted,
                    Findings& findings) {
  if (edges != wanted) report_gap(curve, at, fmt::format("has {} edges, not {}", edges, wanted), findings);
  return edges == wanted;
}

void report_gap(const NamedFeature& curve, const Point& where, std::string_view how, Findings& findings) {
  findings.add(guarantee::curve_cover, where, {curve.id},
               "At {}, {} {}; it must be one chain of mesh edges from end to end.", At{where}, curve, how);
}

void check_measure(const Measure& measure, const NamedFeature& feature, const Point& where, double found,
                   double expected, double allowed, Findings& findings) {
  if (std::fabs(found - expected) <= allowed) return;
  findings.add(measure.guarantee, where, {feature.id},
               "The {} of {} is {:.15g} in the mesh and {:.15g} in the complex; the difference {:.6g} is "
               "above the allowed {:.6g}. {}",
               measure.name, feature, found, expected, found - expected, allowed, measure.reasons);
}

}  // namespace collarmesh::checks
