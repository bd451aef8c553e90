// Measures of tetrahedra.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

namespace {

template <class Real>
struct Vector3 {
  Real x, y, z;

  Vector3(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
  Vector3(const Point& from, const Point& to)
      : x(Real(to.x) - Real(from.x)), y(Real(to.y) - Real(from.y)), z(Real(to.z) - Real(from.z)) {}
  friend Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator*(Real s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Real dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

// An angle in [0, pi], stored as a direction in the upper half plane.
template <class Real>
struct Direction {
  Real x, y;

  bool less_than(const Direction& other) const {
    const Real turn = x * other.y - y * other.x;
    return turn > 0 || (turn == 0 && x > 0 && other.x < 0);  // second case: this angle is 0, the other pi
  }
  double degrees() const { return static_cast<double>(std::atan2(y, x)) * 180 / std::numbers::pi; }
};

template <class Real>
struct Measures {
  TetQuality quality;
  Real conditioning;  ///< |determinant| / longest edge cubed; rounding errors grow with its inverse
};

// Returns the exponent of the power of two by which the tet has to be divided so that eighth powers of
// lengths stay in range: 0 for almost all tets.
int exponent_of_size(const Point& a, const Point& b, const Point& c, const Point& d) {
  double largest = 0;
  for (const Point& p : {b, c, d})
    for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max(largest, std::fabs(p[axis] - a[axis]));
  const bool in_range = largest > 0x1p-64 && largest < 0x1p64;
  return largest > 0 && !in_range ? std::clamp(std::ilogb(largest), -1000, 1000) : 0;
}

template <class Real>
Measures<Real> measure_as(const Point& a, const Point& b, const Point& c, const Point& d) {
  using V = Vector3<Real>;
  const int exponent = exponent_of_size(a, b, c, d);
  const auto scaled = [](Real value, int by) { return by == 0 ? value : std::scalbn(value, by); };
  const Real unit = scaled(1, -exponent);
  const V ab = unit * V(a, b), ac = unit * V(a, c), ad = unit * V(a, d), bc = unit * V(b, c),
          bd = unit * V(b, d), cd = unit * V(c, d);
  const Real l_ab = dot(ab, ab), l_ac = dot(ac, ac), l_ad = dot(ad, ad), l_bc = dot(bc, bc),
             l_bd = dot(bd, bd), l_cd = dot(cd, cd);
  const auto [shortest, longest] = std::minmax({l_ab, l_ac, l_ad, l_bc, l_bd, l_cd});

  // Normals of the faces opposite the corners, all outwards (or all inwards if the tet is inverted).
  const V n_a = cross(bc, bd), n_b = cross(ad, ac), n_c = cross(ab, ad), n_d = cross(ac, ab);
  const Real determinant = -dot(n_d, ad);
  const Real size = std::abs(determinant);
  TetQuality quality;
  quality.volume = static_cast<double>(scaled(determinant / 6, 3 * exponent));

  // |ad|^2 (ab x ac) + |ac|^2 (ad x ab) + |ab|^2 (ac x ad) = 2 det (circumcentre - a)
  const V numerator = Real(-1) * (l_ad * n_d + l_ac * n_c + l_ab * n_b);
  quality.radius_edge =
      size > 0 ? static_cast<double>(std::sqrt(dot(numerator, numerator) / shortest) / (2 * size))
               : std::numeric_limits<double>::infinity();

  // For two normals n, m with a common edge e: -n.m = |n||m| cos, |n x m| = |e| |det| = |n||m| sin.
  const std::array<Direction<Real>, 6> angles{{{-dot(n_c, n_d), std::sqrt(l_ab) * size},
                                               {-dot(n_b, n_d), std::sqrt(l_ac) * size},
                                               {-dot(n_b, n_c), std::sqrt(l_ad) * size},
                                               {-dot(n_a, n_d), std::sqrt(l_bc) * size},
                                               {-dot(n_a, n_c), std::sqrt(l_bd) * size},
                                               {-dot(n_a, n_b), std::sqrt(l_cd) * size}}};
  Direction<Real> least = angles[0], greatest = angles[0];
  for (const Direction<Real>& angle : angles) {
    if (angle.less_than(least)) least = angle;
    if (greatest.less_than(angle)) greatest = angle;
  }
  quality.min_dihedral = least.degrees();
  quality.max_dihedral = greatest.degrees();
  return {quality, size / (longest * std::sqrt(longest))};
}

// Returns the largest angle of the triangle abc.
template <class Real>
Direction<Real> largest_angle(const Vector3<Real>& ab, const Vector3<Real>& ac, const Vector3<Real>& bc) {
  const Vector3<Real> normal = cross(ab, ac);
  const Real twice_area = std::sqrt(dot(normal, normal));
  Direction<Real> largest{dot(ab, ac), twice_area};
  for (const Real x : {-dot(ab, bc), dot(ac, bc)})
    if (const Direction<Real> angle{x, twice_area}; largest.less_than(angle)) largest = angle;
  return largest;
}

}  // namespace

// Measures in double precision first. Rounding errors of volume, radius and angles grow with longest^3 /
// determinant, so flat tets are measured with more digits.
TetQuality measure(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Measures<double> measures = measure_as<double>(a, b, c, d);
  if (measures.conditioning > 1e-4) return measures.quality;
  return measure_as<long double>(a, b, c, d).quality;
}

double largest_face_angle(const Point& a, const Point& b, const Point& c, const Point& d) {
  using Real = long double;
  using V = Vector3<Real>;
  const int exponent = exponent_of_size(a, b, c, d);
  const Real unit = std::scalbn(Real(1), -exponent);
  const V ab = unit * V(a, b), ac = unit * V(a, c), ad = unit * V(a, d), bc = unit * V(b, c),
          bd = unit * V(b, d), cd = unit * V(c, d);
  Direction<Real> largest = largest_angle(ab, ac, bc);
  for (const auto& angle : {largest_angle(ab, ad, bd), largest_angle(ac, ad, cd), largest_angle(bc, bd, cd)})
    if (largest.less_than(angle)) largest = angle;
  return largest.degrees();
}

}  // namespace collarmesh
