#include "common/layer_jacobians.h"

#include <vector>

namespace collarmesh {

namespace {

/// The derivatives of n shape functions at a point, by each of the three coordinates.
template <std::size_t n>
using Derivatives = std::array<std::array<double, n>, 3>;

template <std::size_t n>
double jacobian(const std::array<Point, n>& nodes, const Derivatives<n>& derivatives) {
  std::array<Vector, 3> tangents;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) tangents[axis] = tangents[axis] + derivatives[axis][i] * nodes[i];
  return dot(cross(tangents[0], tangents[1]), tangents[2]);
}

/// A value with its derivatives by each of the three coordinates.
struct Dual {
  double value = 0;
  Vector slope{};

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, b.value * a.slope + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return {a.value / b.value, (a.slope - (a.value / b.value) * b.slope) / b.value};
  }
  friend Dual operator*(double s, const Dual& a) { return {s * a.value, s * a.slope}; }
  friend Dual operator+(double s, const Dual& a) { return {s + a.value, a.slope}; }
  friend Dual operator-(double s, const Dual& a) { return {s - a.value, -1.0 * a.slope}; }
};

template <std::size_t n>
Derivatives<n> slopes_of(const std::array<Dual, n>& functions) {
  Derivatives<n> derivatives{};
  for (std::size_t i = 0; i < n; ++i)
    for (unsigned axis = 0; axis < 3; ++axis) derivatives[axis][i] = functions[i].slope[axis];
  return derivatives;
}

/// Differentiates the shape functions of the 15-node serendipity prism. Its coordinates are barycentric in
/// triangles, and z goes up from -1 to 1.
Derivatives<15> prism_slopes(double x, double y, double z) {
  const Dual second{x, {1, 0, 0}}, third{y, {0, 1, 0}}, up{z, {0, 0, 1}};
  const std::array<Dual, 3> l{1 - (second + third), second, third};
  const Dual below = 0.5 * (1 - up), above = 0.5 * (1 + up), bubble = 1 - up * up;
  std::array<Dual, 15> n;
  for (unsigned i = 0; i < 3; ++i) {
    const unsigned j = (i + 1) % 3;
    const Dual corner = 2 * l[i] - Dual{1, {}};
    n[i] = l[i] * (corner * below - 0.5 * bubble);
    n[i + 3] = l[i] * (corner * above - 0.5 * bubble);
    n[i + 6] = 4 * (l[i] * l[j] * below);
    n[i + 9] = 4 * (l[i] * l[j] * above);
    n[i + 12] = l[i] * bubble;
  }
  return slopes_of(n);
}

/// Differentiates the rational shape functions of the 13-node pyramid (Bedrosian 1992). On its base x and y
/// go from -1 to 1; its apex is at z = 1.
Derivatives<13> pyramid_slopes(double x, double y, double z) {
  const Dual u{x, {1, 0, 0}}, v{y, {0, 1, 0}}, w{z, {0, 0, 1}};
  const Dual room = 1 - w, quotient = (u * v * w) / room;
  constexpr std::array<std::array<double, 2>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<Dual, 13> n;
  for (unsigned i = 0; i < 4; ++i) {
    const auto [s, t] = signs[i];
    n[i] = 0.25 * ((s * u + t * v - Dual{1, {}}) * ((1 + s * u) * (1 + t * v) - w + (s * t) * quotient));
    n[i + 9] = (w * (1 + s * u - w) * (1 + t * v - w)) / room;
  }
  n[4] = w * (2 * w - Dual{1, {}});
  const Dual along_u = (1 + u - w) * (1 - u - w), along_v = (1 + v - w) * (1 - v - w);
  n[5] = 0.5 * ((along_u * (1 - v - w)) / room);
  n[6] = 0.5 * ((along_v * (1 + u - w)) / room);
  n[7] = 0.5 * ((along_u * (1 + v - w)) / room);
  n[8] = 0.5 * ((along_v * (1 - u - w)) / room);
  return slopes_of(n);
}

constexpr double gauss = 0.7745966692414834;  // the square root of 0.6

/// Corners of a triangle, and its integration points of degree five (Radon).
constexpr std::array<std::array<double, 2>, 10> places_across{{{0, 0},
                                                               {1, 0},
                                                               {0, 1},
                                                               {1.0 / 3, 1.0 / 3},
                                                               {0.4701420641051151, 0.4701420641051151},
                                                               {0.0597158717897698, 0.4701420641051151},
                                                               {0.4701420641051151, 0.0597158717897698},
                                                               {0.1012865073234563, 0.1012865073234563},
                                                               {0.7974269853530873, 0.1012865073234563},
                                                               {0.1012865073234563, 0.7974269853530873}}};

std::vector<Derivatives<15>> slopes_in_prism() {
  std::vector<Derivatives<15>> all;
  for (const double z : {-1.0, -gauss, 0.0, gauss, 1.0})
    for (const auto& [x, y] : places_across) all.push_back(prism_slopes(x, y, z));
  return all;
}

std::vector<Derivatives<13>> slopes_in_pyramid() {
  std::vector<Derivatives<13>> all;
  for (const double z : {0.0, 0.5 * (1 - gauss), 0.5, 0.5 * (1 + gauss)})
    for (const double x : {-1.0, -gauss, 0.0, gauss, 1.0})
      for (const double y : {-1.0, -gauss, 0.0, gauss, 1.0})
        all.push_back(pyramid_slopes(x * (1 - z), y * (1 - z), z));
  return all;
}

template <std::size_t n, std::size_t corners>
double least_of(const std::array<Point, corners>& p, const std::array<Point, n - corners>& mid,
                const std::vector<Derivatives<n>>& slopes) {
  std::array<Point, n> nodes;
  // Nodes are taken relative to a corner, so that rounding depends on the size of the cell only.
  for (std::size_t i = 0; i < n; ++i) nodes[i] = (i < corners ? p[i] : mid[i - corners]) - p[0];
  double least = INFINITY;
  for (const Derivatives<n>& at : slopes) least = std::min(least, jacobian(nodes, at));
  return least;
}

}  // namespace

double least_jacobian_at_points(const PrismCorners& corners, const std::array<Point, 9>& mid) {
  static const std::vector<Derivatives<15>> slopes = slopes_in_prism();
  return least_of<15, 6>(corners, mid, slopes);
}

double least_jacobian_at_points(const PyramidCorners& corners, const std::array<Point, 8>& mid) {
  static const std::vector<Derivatives<13>> slopes = slopes_in_pyramid();
  return least_of<13, 5>(corners, mid, slopes);
}

}  // namespace collarmesh
