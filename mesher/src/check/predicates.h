#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "check/findings.h"
#include "check/guarantees.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/geometry.h"

/// Predicates for the guarantees of single tets, nodes and features. They take the measured values
/// themselves, so they work wherever the mesh is stored: `check` uses them for a whole mesh, each MPI rank
/// for its part.
namespace collarmesh::checks {

/// The name of an entity in findings: "Tet 5", or only "Tet" on one of many ranks, where numbers would
/// mislead.
struct Named {
  std::string_view kind;
  Index id = none;
};

/// A feature or region of the complex.
struct NamedFeature {
  std::string_view kind;  ///< "curve", "patch" or "region"
  Index id;               ///< none: all with this tag
  Tag tag;
};

/// Adds a finding unless the volume of a tet is positive by exact arithmetic; `volume` is for the message.
/// Returns whether it is positive.
bool check_orientation(const Named& tet, const std::array<Point, 4>& corners, double volume,
                       Findings& findings);

/// Adds a finding if the Jacobian determinant of a tet of second order is not positive everywhere.
void check_jacobian(const Named& tet, const CurvedTet& nodes, Tag tag, Findings& findings);

/// Adds a finding if a node is farther away from its feature than is allowed.
void check_off_feature(std::string_view guarantee, const Named& node, const Point& at, double distance,
                       double allowed, const NamedFeature& feature, Findings& findings);

/// Adds a finding unless `wanted` edges of a curve meet at a point of the curve, as in a chain. `edges`: how
/// many do. Returns whether these numbers are equal.
bool check_edges_at(const NamedFeature& curve, const Point& at, std::ptrdiff_t edges, std::ptrdiff_t wanted,
                    Findings& findings);

/// Adds the finding that the edges of a curve are not one chain. `how` follows the curve's name.
void report_gap(const NamedFeature& curve, const Point& where, std::string_view how, Findings& findings);

/// A kind of measure, such as the area of patches, and the reasons why its value in the mesh may differ from
/// that in the complex.
struct Measure {
  std::string_view guarantee, name, reasons;
};
inline constexpr Measure volume_of_region{
    guarantee::region_volume, "volume",
    "Tets are missing or in a wrong region, or the surface was not reproduced."},
    area_of_patch{guarantee::patch_area, "area", "Faces are missing or doubled."};

/// Adds a finding if a measure of the mesh differs from that of the complex by more than is allowed.
void check_measure(const Measure& measure, const NamedFeature& feature, const Point& where, double found,
                   double expected, double allowed, Findings& findings);

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

template <>
struct fmt::formatter<collarmesh::checks::NamedFeature> {
  constexpr auto parse(format_parse_context& context) { return context.begin(); }
  template <class Context>
  auto format(const collarmesh::checks::NamedFeature& feature, Context& context) const {
    if (feature.id == collarmesh::none)
      return fmt::format_to(context.out(), "the {} with tag {}", feature.kind, feature.tag);
    return fmt::format_to(context.out(), "{} {} (tag {})", feature.kind, feature.id, feature.tag);
  }
};
