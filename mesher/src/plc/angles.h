#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "plc/features.h"

/// Angles between rays and facets at a common point. Directions are unit vectors, angles degrees.
namespace collarmesh::plc {

/// Returns the angle between two vectors, in [0, 180], accurate also near 0 and 180.
double angle_between(const Vector& u, const Vector& v);

/// The planar sector between two rays.
struct Sector {
  Vector u, v;
};
double angle_between(const Vector& ray, const Sector& sector);
/// Returns the smallest angle between a ray of one sector and a ray of the other. Precondition: the sectors
/// do not cross.
double angle_between(const Sector& s, const Sector& t);

/// Returns how sharply a fan of sectors (between neighbouring rays in order around a point) folds: the
/// smallest angle in space between two of its rays that are far apart along the fan. Far means halfway around
/// a closed fan, and 90, 135 or 180 degrees in an open one. The result is 180 for a flat closed fan, the
/// aperture for a round cone, and at least 90 for any flat open fan.
double fold_angle(std::span<const Vector> rays, bool closed);

/// Returns the points where a smooth patch folds to an angle below 90 degrees (such as the apex of a cone);
/// they become vertices. Reads the patches and triangles of `plc` and its planar tolerance; needs no curves.
std::vector<Index> find_folds(std::span<const Point> points, const Plc& plc,
                              std::span<const FeatureSegment> segments);

/// Returns the smallest angle of each kind at each curve and vertex of the complex.
std::vector<Crease> measure_angles(const Plc& plc);

}  // namespace collarmesh::plc
