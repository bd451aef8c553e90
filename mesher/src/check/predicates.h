#pragma once

#include <array>
#include <string_view>

#include "check/findings.h"
#include "check/guarantees.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/geometry.h"

/// The guarantees of single tets and nodes: predicates over what they look at, wherever the mesh is. `check`
/// uses them for a whole mesh, each rank of many for its part of one.
namespace collarmesh::checks {

/// What findings call an entity: "Tet 5", or "Tet" on one rank of many, where numbers say nothing.
struct Named {
  std::string_view kind;
  Index id = none;
};

/// The feature that a node is to lie on.
struct NamedFeature {
  std::string_view kind;  ///< "curve" or "patch"
  Index id;
  Tag tag;
};

/// Finds a tet without positive volume, by exact arithmetic; `volume` is for the message. Returns whether it
/// is positive.
bool check_orientation(const Named& tet, const std::array<Point, 4>& corners, double volume,
                       Findings& findings);

/// Finds a tet of second order whose Jacobian determinant is not positive everywhere in it.
void check_jacobian(const Named& tet, const CurvedTet& nodes, Tag tag, Findings& findings);

/// Finds a node that is farther away from its feature than is allowed.
void check_off_feature(std::string_view guarantee, const Named& node, const Point& at, double distance,
                       double allowed, const NamedFeature& feature, Findings& findings);

}  // namespace collarmesh::checks

template <>
struct fmt::formatter<collarmesh::checks::Named> {
  constexpr auto parse(format_parse_context& context) { return context.begin(); }
  template <class Context>
  auto format(const collarmesh::checks::Named& named, Context& context) const {
    if (named.id == collarmesh::none) return fmt::format_to(context.out(), "{}", named.kind);
    return fmt::format_to(context.out(), "{} {}", named.kind, named.id);
  }
};
