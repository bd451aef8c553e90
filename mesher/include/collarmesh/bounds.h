#pragma once

#include <optional>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh {

/// What every stage keeps and `check` judges by. Angles in degrees.
struct Bounds {
  double radius_edge = 2;  ///< largest circumradius / shortest edge in regions, outside collars; at least 1
  /// Smallest dihedral angle of thin tets, which may exceed that ratio; at a sharper crease half its angle.
  /// Their dihedral angles and those of their faces are at most 150. 0: no tet may exceed the ratio.
  double thin_angle = 8;
  double collar_angle = 150;  ///< largest dihedral angle in collars; 100 to 175
  double crease_angle = 60;   ///< features that meet below it form a crease and get a collar
  /// Largest distance from smooth patches and curves, absolute; 0: `default_tolerance`.
  double distance = 0;
  std::optional<SurfaceTolerance> tolerance = {};  ///< by place, instead of the distance
  /// The share of the bounds on the angles of thin tets, counted from 0 and from 180 degrees, that is kept
  /// free for what moves vertices afterwards, as `project_boundary` does; 0 to 0.5.
  double reserve = 0;
};

/// How far from the smooth patches and curves of a complex these bounds let a mesh be that is made with a
/// target edge length (0: its default).
SurfaceTolerance tolerance_of(const Plc& plc, const Bounds& bounds, double size, int order = 1);

/// The same for a mesh of which the target edge length is not known: what the largest one lets it be.
SurfaceTolerance tolerance_of_any_size(const Plc& plc, const Bounds& bounds);

}  // namespace collarmesh
