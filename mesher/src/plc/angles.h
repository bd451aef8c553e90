#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc_builder.h"

/// Angles between rays and facets at a common point. Directions are unit vectors, angles degrees.
namespace collarmesh::build {

/// In [0, 180], accurate near both ends.
double angle_between(const Vector& u, const Vector& v);

/// The planar sector between two rays.
struct Sector {
  Vector u, v;
};
double angle_between(const Vector& ray, const Sector& sector);
/// Precondition: the sectors do not cross.
double angle_between(const Sector& s, const Sector& t);

/// How sharply a fan of sectors (between neighbouring rays in order around a point) folds: the
/// smallest angle in space between two of its rays that are far apart along the fan. Far is half
/// way round a closed fan, and 90, 135 or 180 degrees in an open one. 180 for a closed flat fan, the
/// aperture for a round cone, at least 90 for any open flat one.
double fold_angle(std::span<const Vector> rays, bool closed);

/// The smallest angle of each kind at each curve and vertex of the complex, and at each other
/// point where a smooth patch folds by an angle below 90 degrees.
std::vector<Crease> measure_angles(const Plc& plc);

}  // namespace collarmesh::build
