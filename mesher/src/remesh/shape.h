#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collarmesh/geometry.h"
#include "common/cell_shapes.h"

namespace collarmesh::remeshing {

using Corners = std::array<Point, 4>;

/// In `shape_quality` the sines of obtuse dihedral angles are multiplied by this factor.
constexpr double obtuse_weight = 0.7;

/// Returns the smallest sine of a tet's dihedral angles, after multiplying the sines of obtuse angles by
/// `obtuse_weight`: at most about 0.94. Returns 0 for a flat tet and -1 for an inverted one.
inline double shape_quality(const Corners& p) {
  const Vector ab = p[1] - p[0], ac = p[2] - p[0], ad = p[3] - p[0], bc = p[2] - p[1], bd = p[3] - p[1],
               cd = p[3] - p[2];
  const std::array<Vector, 4> normals{cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)};
  const double six_volume = -dot(normals[3], ad);
  if (six_volume <= 0) return six_volume < 0 ? -1 : 0;
  // Edge ij lies in the faces opposite the other two corners, k and l; the sine there is 6V |ij| / (2A_k
  // 2A_l).
  double worst = INFINITY;
  const auto see = [&](const Vector& edge, const Vector& k, const Vector& l) {
    double squared_sine = squared_norm(edge) / (squared_norm(k) * squared_norm(l));
    if (dot(k, l) > 0) squared_sine *= obtuse_weight * obtuse_weight;
    worst = std::min(worst, squared_sine);
  };
  see(ab, normals[2], normals[3]);
  see(ac, normals[1], normals[3]);
  see(ad, normals[1], normals[2]);
  see(bc, normals[0], normals[3]);
  see(bd, normals[0], normals[2]);
  see(cd, normals[0], normals[1]);
  return six_volume * std::sqrt(worst);
}

struct Circumsphere {
  double squared_radius;
  double shortest_squared_edge, longest_squared_edge;
  double six_volume;  ///< absolute, input units cubed
};

inline Circumsphere circumsphere(const Corners& p) {
  const Vector u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  const Vector vw = cross(v, w);
  const double det = dot(u, vw);
  const Vector centre = (uu * vw + vv * cross(w, u) + ww * cross(u, v)) / (2 * det);
  const double bc = squared_distance(p[1], p[2]), bd = squared_distance(p[1], p[3]),
               cd = squared_distance(p[2], p[3]);
  return {squared_norm(centre), std::min({uu, vv, ww, bc, bd, cd}), std::max({uu, vv, ww, bc, bd, cd}),
          std::fabs(det)};
}

/// Returns the edges of a tet, longest first: removing the longest edges of a sliver helps most. `length`
/// returns the distance of two points, or a number that grows with it, such as its square.
template <class Length>
std::array<EdgePlaces, 6> longest_first(const Corners& p, const Length& length) {
  std::array<std::pair<double, EdgePlaces>, 6> by_length;
  std::ranges::transform(cell_shapes::corner_pairs, by_length.begin(), [&](const EdgePlaces& edge) {
    return std::pair(-length(p[edge[0]], p[edge[1]]), edge);
  });
  std::ranges::sort(by_length);
  std::array<EdgePlaces, 6> edges;
  std::ranges::transform(by_length, edges.begin(), [](const auto& edge) { return edge.second; });
  return edges;
}

}  // namespace collarmesh::remeshing
