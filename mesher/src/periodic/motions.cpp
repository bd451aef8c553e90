#include "periodic/motions.h"

#include <array>
#include <cmath>
#include <numbers>

namespace collarmesh::periodicity {

namespace {

/// Returns cosine and sine of an angle in degrees, exact at multiples of a right angle.
std::array<double, 2> cosine_and_sine(double degrees) {
  const double turns = degrees / 90, whole = std::round(turns);
  if (turns == whole) {
    constexpr std::array<std::array<double, 2>, 4> exact{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return exact[static_cast<std::size_t>(whole - 4 * std::floor(whole / 4))];
  }
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Motion rotation(const Point& through, const Vector& direction, double degrees) {
  const Vector n = direction / norm(direction);
  const auto [cosine, sine] = cosine_and_sine(degrees);
  const double rest = 1 - cosine;
  Motion motion;  // Rodrigues' formula
  motion.rows = {
      Vector{cosine + rest * n.x * n.x, rest * n.x * n.y - sine * n.z, rest * n.x * n.z + sine * n.y},
      Vector{rest * n.y * n.x + sine * n.z, cosine + rest * n.y * n.y, rest * n.y * n.z - sine * n.x},
      Vector{rest * n.z * n.x - sine * n.y, rest * n.z * n.y + sine * n.x, cosine + rest * n.z * n.z}};
  motion.shift = through - motion(through);
  return motion;
}

Motion inverse(const Motion& motion) {
  const auto& [x, y, z] = motion.rows;
  Motion back;
  back.rows = {Vector{x.x, y.x, z.x}, Vector{x.y, y.y, z.y}, Vector{x.z, y.z, z.z}};
  back.shift = Point{0, 0, 0} - back(motion.shift);
  return back;
}

Motion composed(const Motion& first, const Motion& then) {
  Motion both;
  for (std::size_t row = 0; row < 3; ++row) {
    const Vector& r = then.rows[row];
    both.rows[row] = r.x * first.rows[0] + r.y * first.rows[1] + r.z * first.rows[2];
  }
  both.shift = then(first.shift);
  return both;
}

}  // namespace collarmesh::periodicity
