#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "collarmesh/geometry.h"

namespace collarmesh::distributed {

/// The extreme dihedral angles of a tet, degrees.
struct ExtremeAngles {
  double least = 180, most = 0;
};

/// Returns the extreme angles. Precondition: the tet is not flat.
inline ExtremeAngles extreme_angles(const std::array<Point, 4>& p) {
  const Vector ab = p[1] - p[0], ac = p[2] - p[0], ad = p[3] - p[0], bc = p[2] - p[1], bd = p[3] - p[1];
  // The normals of the faces opposite the corners, all outwards or all inwards.
  const std::array<Vector, 4> normals{cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)};
  std::array<double, 4> lengths;
  for (std::size_t i = 0; i < 4; ++i) lengths[i] = norm(normals[i]);
  assert(std::min({lengths[0], lengths[1], lengths[2], lengths[3]}) > 0);
  double least = 1, most = -1;  // the least and the largest cosine of an angle
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double cosine = -dot(normals[i], normals[j]) / (lengths[i] * lengths[j]);
      least = std::min(least, cosine);
      most = std::max(most, cosine);
    }
  constexpr double degrees = 180 / std::numbers::pi;
  return {degrees * std::acos(std::min(most, 1.0)), degrees * std::acos(std::max(least, -1.0))};
}

}  // namespace collarmesh::distributed
