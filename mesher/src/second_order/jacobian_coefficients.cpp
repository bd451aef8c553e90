#include "second_order/jacobian_coefficients.h"

namespace collarmesh::second_order {

namespace {

constexpr std::array<std::array<unsigned, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// Calls visit(coefficient, u, v, w) for each way to give the three corners of each coefficient to the three
// linear functions that the determinant is made of. The mean over the six ways is the coefficient.
template <class Visit>
void visit_ways(const Visit& visit) {
  std::size_t coefficient = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = i; j < 4; ++j)
      for (unsigned k = j; k < 4; ++k, ++coefficient) {
        visit(coefficient, i, j, k), visit(coefficient, i, k, j);
        visit(coefficient, j, i, k), visit(coefficient, j, k, i);
        visit(coefficient, k, i, j), visit(coefficient, k, j, i);
      }
}

constexpr double scale = 8.0 / 6;

}  // namespace

JacobianCoefficients::JacobianCoefficients(const CurvedTet& nodes) : values_{} {
  std::array<std::array<Point, 4>, 4> bezier;
  for (std::size_t i = 0; i < 4; ++i) bezier[i][i] = nodes[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = ends[e];
    bezier[i][j] = bezier[j][i] = 2 * nodes[4 + e] - 0.5 * (nodes[i] + nodes[j]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) derivatives_[k][i] = bezier[i][k + 1] - bezier[i][0];
  visit_ways([this](std::size_t c, unsigned u, unsigned v, unsigned w) {
    values_[c] += scale * dot(cross(derivatives_[0][u], derivatives_[1][v]), derivatives_[2][w]);
  });
}

std::array<Vector, 6> JacobianCoefficients::gradient(const Values& weights) const {
  std::array<std::array<Vector, 4>, 3> by_derivatives{};
  visit_ways([&](std::size_t c, unsigned u, unsigned v, unsigned w) {
    const Vector &a = derivatives_[0][u], &b = derivatives_[1][v], &d = derivatives_[2][w];
    const double weight = scale * weights[c];
    by_derivatives[0][u] = by_derivatives[0][u] + weight * cross(b, d);
    by_derivatives[1][v] = by_derivatives[1][v] + weight * cross(d, a);
    by_derivatives[2][w] = by_derivatives[2][w] + weight * cross(a, b);
  });
  std::array<std::array<Vector, 4>, 4> by_bezier{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      by_bezier[i][k + 1] = by_bezier[i][k + 1] + by_derivatives[k][i];
      by_bezier[i][0] = by_bezier[i][0] - by_derivatives[k][i];
    }
  std::array<Vector, 6> found;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = ends[e];
    found[e] = 2.0 * (by_bezier[i][j] + by_bezier[j][i]);
  }
  return found;
}

}  // namespace collarmesh::second_order
