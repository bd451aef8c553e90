#include "second_order/jacobian_coefficients.h"

#include "common/cell_shapes.h"

namespace collarmesh::second_order {

namespace {

// The determinant is the triple product of three linear vector functions. A Bernstein coefficient is 8 times
// the mean of this product over the six ways to assign its three corners to the functions. A Way is one
// assignment, with its coefficient and its weight, which is 8/6 times the number of equal assignments.
struct Way {
  std::size_t coefficient = 0;
  double weight = 0;
};
using Ways = std::array<std::array<std::array<Way, 4>, 4>, 4>;

constexpr Ways ways = [] {
  Ways made;
  std::size_t coefficient = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = i; j < 4; ++j)
      for (unsigned k = j; k < 4; ++k, ++coefficient)
        for (const auto& [u, v, w] : std::array<std::array<unsigned, 3>, 6>{
                 {{i, j, k}, {i, k, j}, {j, i, k}, {j, k, i}, {k, i, j}, {k, j, i}}}) {
          made[u][v][w].coefficient = coefficient;
          made[u][v][w].weight += 8.0 / 6;
        }
  return made;
}();

}  // namespace

JacobianCoefficients::JacobianCoefficients(const CurvedTet& nodes) : values_{} {
  std::array<std::array<Point, 4>, 4> bezier;
  for (std::size_t i = 0; i < 4; ++i) bezier[i][i] = nodes[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = cell_shapes::tet_edges[e];
    bezier[i][j] = bezier[j][i] = 2 * nodes[4 + e] - 0.5 * (nodes[i] + nodes[j]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) derivatives_[k][i] = bezier[i][k + 1] - bezier[i][0];
  for (unsigned u = 0; u < 4; ++u)
    for (unsigned v = 0; v < 4; ++v) {
      const Vector product = cross(derivatives_[0][u], derivatives_[1][v]);
      for (unsigned w = 0; w < 4; ++w)
        values_[ways[u][v][w].coefficient] += ways[u][v][w].weight * dot(product, derivatives_[2][w]);
    }
}

std::array<Vector, 6> JacobianCoefficients::gradient(const Values& weights) const {
  const auto weight = [&](unsigned u, unsigned v, unsigned w) {
    return ways[u][v][w].weight * weights[ways[u][v][w].coefficient];
  };
  std::array<std::array<Vector, 4>, 3> by_derivatives{};
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < 4; ++j) {
      const Vector of_0 = cross(derivatives_[1][i], derivatives_[2][j]),
                   of_1 = cross(derivatives_[2][i], derivatives_[0][j]),
                   of_2 = cross(derivatives_[0][i], derivatives_[1][j]);
      for (unsigned k = 0; k < 4; ++k) {
        by_derivatives[0][k] = by_derivatives[0][k] + weight(k, i, j) * of_0;
        by_derivatives[1][k] = by_derivatives[1][k] + weight(j, k, i) * of_1;
        by_derivatives[2][k] = by_derivatives[2][k] + weight(i, j, k) * of_2;
      }
    }
  std::array<std::array<Vector, 4>, 4> by_bezier{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      by_bezier[i][k + 1] = by_bezier[i][k + 1] + by_derivatives[k][i];
      by_bezier[i][0] = by_bezier[i][0] - by_derivatives[k][i];
    }
  std::array<Vector, 6> found;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = cell_shapes::tet_edges[e];
    found[e] = 2.0 * (by_bezier[i][j] + by_bezier[j][i]);
  }
  return found;
}

}  // namespace collarmesh::second_order
