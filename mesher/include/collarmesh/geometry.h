#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// Points, vectors and the few formulas that every module needs. Lengths are in input units.
namespace collarmesh {

/// Index of a point, feature or element in the array that holds it.
using Index = std::uint32_t;

/// Stands for "no such entity".
inline constexpr Index none = 0xffffffffU;

/// The label that a source (CAD face id, .poly marker, file number) gave to an entity; 0 if it gave none.
using Tag = std::int64_t;

/// A position or a displacement in space.
struct Point {
  double x = 0, y = 0, z = 0;

  double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  double operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Point&, const Point&) = default;
};
using Vector = Point;

inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(double s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Point operator*(const Point& a, double s) { return s * a; }
inline Point operator/(const Point& a, double s) { return {a.x / s, a.y / s, a.z / s}; }

inline double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_norm(const Vector& a) { return dot(a, a); }
inline double norm(const Vector& a) { return std::sqrt(squared_norm(a)); }
inline double squared_distance(const Point& a, const Point& b) { return squared_norm(a - b); }
inline double distance(const Point& a, const Point& b) { return std::sqrt(squared_distance(a, b)); }

/// Returns six times the signed volume of the tetrahedron abcd, positive when (b-a) x (c-a) points towards d.
/// Rounded, for measures only: decisions use the exact predicates.
inline double six_volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Axis-parallel box; empty (min > max) by default.
struct Box {
  Point min{INFINITY, INFINITY, INFINITY};
  Point max{-INFINITY, -INFINITY, -INFINITY};

  void add(const Point& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  void add(const Box& b) {
    min = {std::min(min.x, b.min.x), std::min(min.y, b.min.y), std::min(min.z, b.min.z)};
    max = {std::max(max.x, b.max.x), std::max(max.y, b.max.y), std::max(max.z, b.max.z)};
  }
  bool empty() const { return min.x > max.x; }
  double diagonal() const { return empty() ? 0 : distance(min, max); }
  Point centre() const { return 0.5 * (min + max); }
};

}  // namespace collarmesh
