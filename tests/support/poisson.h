#pragma once

#include <functional>

#include "collarmesh/tet_mesh.h"

/// A small finite element solver: the judge of meshes that their users are.
namespace collarmesh::testing {

/// A function with what the Poisson problem -div grad u = f needs of it.
struct Solution {
  std::function<double(const Point&)> value;
  std::function<Vector(const Point&)> gradient;
  std::function<double(const Point&)> load;  ///< f
  /// Is the value given at this point of the boundary? By default it is on all of it; elsewhere the normal
  /// derivative has to be zero.
  std::function<bool(const Point&)> is_given = [](const Point&) { return true; };
};

struct PoissonErrors {
  double l2;                ///< of the solution
  double h1;                ///< of its gradient, in L2
  double element_size;      ///< cube root of the mean volume of a tet
  double condition_number;  ///< of the stiffness matrix without boundary nodes; 0: not asked for
  std::size_t unknowns;
};

/// Linear or, with mid-side nodes, isoparametric quadratic elements; the solution's values are given at
/// the nodes on the boundary, or on its part where they are to be given. The condition number is that of the
/// extreme eigenvalues, by power and inverse iteration. Throws std::runtime_error when there are no inner
/// nodes or the matrix is not positive definite.
PoissonErrors solve_poisson(const TetMesh& mesh, const Solution& exact, bool with_condition_number = false);

/// Smooth, not a polynomial, with all derivatives of the size of one.
Solution smooth_solution();

}  // namespace collarmesh::testing
