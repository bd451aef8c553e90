#pragma once

#include <optional>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh {

/// The bounds that every stage keeps and that `check` judges by. Angles in degrees.
struct Bounds {
  double radius_edge = 2;  ///< largest circumradius / shortest edge in regions, outside collars; at least 1
  /// Smallest dihedral angle that thin tets, those that exceed `radius_edge`, may have; 0: no tet may be
  /// thin. At a crease sharper than twice this, half of the crease's angle is enough. Where the input forces
  /// edges to be short, as across a thin wall, half of the angle that such edges permit is enough. Dihedral
  /// and face angles of thin tets are at most 150.
  double thin_angle = 8;
  /// Allows thin tets only at creases and in narrow places; if false, anywhere. A place is narrow if two
  /// features without a common point, or two features that meet in a crease, are closer there than the
  /// longest edge of the tet divided by `radius_edge`.
  bool thin_in_narrow_places_only = false;
  double collar_angle = 150;  ///< largest dihedral angle in collars; 100 to 175
  double crease_angle = 60;   ///< features that meet at a smaller angle form a crease and get a collar
  /// Largest distance of the mesh from smooth patches and curves, absolute; 0: `default_tolerance`.
  double distance = 0;
  std::optional<SurfaceTolerance> tolerance = {};  ///< a tolerance that depends on the place; replaces
                                                   ///< `distance`
  /// Share by which some bounds are tightened until later stages have moved vertices (`project_boundary`):
  /// the bounds on angles of thin tets (measured from 0 or 180 degrees) and the bound on the width of narrow
  /// places. 0 to 0.5.
  double reserve = 0;
  /// Lowers the bound on the smallest angle of thin tets where the input forces edges to be short. Every mesh
  /// made with false also keeps the bounds for true.
  bool lower_where_forced = true;
  /// Requires that no tet has all corners on boundaries, interfaces or patches inside regions. Where features
  /// meet, at least two tets then share the angle between them, so the bound on each is halved.
  bool interior_node = false;

  /// Returns the least number of tets that share the angle at a crease or forced edge.
  double tets_across() const { return interior_node ? 2 : 1; }
};

/// Returns the distance that these bounds allow between the smooth patches and curves of a complex and a mesh
/// with cells of this order. `size`: target edge length of the mesh, absolute; 0: the default length.
SurfaceTolerance tolerance_of(const Plc& plc, const Bounds& bounds, double size, int order = 1);

/// Returns the distance for a mesh whose target edge length and order are unknown: the largest one over all
/// lengths and orders.
SurfaceTolerance tolerance_of_any_size(const Plc& plc, const Bounds& bounds);

}  // namespace collarmesh
