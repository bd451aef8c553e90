#pragma once

#include <array>
#include <string_view>

#include "check/findings.h"
#include "check/guarantees.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/geometry.h"

/// Predicates for the guarantees of single tets and nodes. They take the coordinates themselves, so they work
/// wherever the mesh is stored: `check` uses them for a whole mesh, each MPI rank for its part.
namespace collarmesh::checks {

/// The name of an entity in findings: "Tet 5", or only "Tet" on one of many ranks, where numbers would
/// mislead.
struct Named {
  std::string_view kind;
  Index id = none;
};

/// The feature that a node should lie on.
struct NamedFeature {
  std::string_view kind;  ///< "curve" or "patch"
  Index id;
  Tag tag;
};

/// Adds a finding if a tet has no positive volume, by exact arithmetic; `volume` is for the message. Returns
/// whether it is positive.
bool check_orientation(const Named& tet, const std::array<Point, 4>& corners, double volume,
                       Findings& findings);

/// Adds a finding if the Jacobian determinant of a tet of second order is not positive everywhere.
void check_jacobian(const Named& tet, const CurvedTet& nodes, Tag tag, Findings& findings);

/// Adds a finding if a node is farther away from its feature than is allowed.
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
