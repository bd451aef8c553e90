#pragma once

#include <algorithm>
#include <array>

#include "collarmesh/curved_tet.h"

namespace collarmesh::second_order {

/// The Bernstein coefficients of the Jacobian determinant, a cubic polynomial, of a tetrahedron of second
/// order. If the edges are straight, all coefficients are six times the volume. The determinant is nowhere
/// below the smallest coefficient (Johnen, Remacle and Geuzaine 2013).
class JacobianCoefficients {
 public:
  static constexpr std::size_t count = 20;
  using Values = std::array<double, count>;

  explicit JacobianCoefficients(const CurvedTet& nodes);

  const Values& values() const { return values_; }
  double least() const { return *std::ranges::min_element(values_); }
  /// Returns the gradient of the weighted sum of the coefficients with respect to the six mid-edge nodes.
  std::array<Vector, 6> gradient(const Values& weights) const;

 private:
  // Half the derivative along the edge from corner 0 to k + 1, a linear function given by its value at each
  // corner i.
  std::array<std::array<Vector, 4>, 3> derivatives_;
  Values values_;
};

}  // namespace collarmesh::second_order
