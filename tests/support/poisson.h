#pragma once

#include <functional>

#include "collarmesh/tet_mesh.h"

/// A small finite element solver, which judges meshes as their users do.
namespace collarmesh::testing {

/// The exact solution u of a Poisson problem -div grad u = f, with its data.
struct Solution {
  std::function<double(const Point&)> value;
  std::function<Vector(const Point&)> gradient;
  std::function<double(const Point&)> load;  ///< the right-hand side f
  /// Returns whether the value is given at this point of the boundary; elsewhere the normal derivative must
  /// be zero. By default all values are given.
  std::function<bool(const Point&)> is_given = [](const Point&) { return true; };
};

struct PoissonErrors {
  double l2;                ///< error of the solution in L2
  double h1;                ///< error of its gradient in L2
  double element_size;      ///< cube root of the mean volume of a tet
  double condition_number;  ///< condition of the stiffness matrix without boundary nodes; 0: not computed
  std::size_t unknowns;
};

/// Solves with linear elements or, if there are mid-edge nodes, isoparametric quadratic ones. The solution's
/// values are given at the nodes on the boundary, or on the part where `is_given` says so. The condition
/// number comes from the extreme eigenvalues, by power and inverse iteration. Throws std::runtime_error if
/// there are no inner nodes or the matrix is not positive definite.
PoissonErrors solve_poisson(const TetMesh& mesh, const Solution& exact, bool with_condition_number = false);

/// Returns a smooth solution that is no polynomial; all its derivatives are of the order of 1.
Solution smooth_solution();

}  // namespace collarmesh::testing
