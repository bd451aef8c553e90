#include "support/poisson.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace collarmesh::testing {

namespace {

using Barycentric = std::array<double, 4>;

struct QuadraturePoint {
  Barycentric at;
  double weight;  // weights sum to 1
};

// Returns the product of Gauss rules on a cube collapsed to a tetrahedron: exact for polynomials of degree 5.
std::vector<QuadraturePoint> quadrature() {
  constexpr std::array<double, 4> at{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                     0.93056815579702629};
  constexpr std::array<double, 4> weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                         0.17392742256872693};
  std::vector<QuadraturePoint> points;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) {
        const double u = at[i], v = at[j] * (1 - u), w = at[k] * (1 - u - v);
        const double jacobian = (1 - at[i]) * (1 - at[i]) * (1 - at[j]);
        points.push_back({{1 - u - v - w, u, v, w}, 6 * jacobian * weight[i] * weight[j] * weight[k]});
      }
  return points;
}

// The ends of the edges with mid-edge nodes, in the order of TetMesh: ab, bc, ca, ad, bd, cd.
constexpr std::array<std::array<unsigned, 2>, 6> sides{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// Shape functions and their derivatives with respect to the second to fourth barycentric coordinate.
struct Shape {
  Eigen::VectorXd value;
  Eigen::MatrixXd derivative;  // nodes x 3
};

Shape shape(const Barycentric& l, int order) {
  Eigen::Matrix<double, 4, 3> corner;
  corner << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  if (order == 1) return {Eigen::Vector4d(l[0], l[1], l[2], l[3]), corner};
  Shape s{Eigen::VectorXd(10), Eigen::MatrixXd(10, 3)};
  for (unsigned i = 0; i < 4; ++i) {
    s.value(i) = l[i] * (2 * l[i] - 1);
    s.derivative.row(i) = (4 * l[i] - 1) * corner.row(i);
  }
  for (unsigned e = 0; e < 6; ++e) {
    const auto [i, j] = sides[e];
    s.value(4 + e) = 4 * l[i] * l[j];
    s.derivative.row(4 + e) = 4 * (l[i] * corner.row(j) + l[j] * corner.row(i));
  }
  return s;
}

class PoissonProblem {
 public:
  PoissonProblem(const TetMesh& mesh, const Solution& exact)
      : mesh_(mesh), exact_(exact), points_(quadrature()) {
    for (const QuadraturePoint& p : points_) shapes_.push_back(shape(p.at, mesh.order()));
    number_unknowns();
    assemble();
  }

  PoissonErrors solve(bool with_condition_number) {
    if (count_ == 0) throw std::runtime_error("the values at all nodes are given");
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Eigen::IncompleteCholesky<double>> solver(
        matrix_);
    solver.setTolerance(1e-12);
    PoissonErrors errors = measure(solver.solve(right_));
    if (solver.info() != Eigen::Success)
      throw std::runtime_error("the stiffness matrix is not positive definite");
    if (with_condition_number) errors.condition_number = condition_number();
    return errors;
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  std::vector<Index> nodes(std::size_t tet) const {
    std::vector<Index> n(mesh_.tets[tet].begin(), mesh_.tets[tet].end());
    if (mesh_.order() == 2)
      n.insert(n.end(), mesh_.tet_mid_nodes[tet].begin(), mesh_.tet_mid_nodes[tet].end());
    return n;
  }

  void number_unknowns() {
    constexpr int unused = -2, given = -1;
    unknown_.assign(mesh_.points.size(), unused);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      for (const Index n : nodes(t)) unknown_[n] = 0;
    const auto mark = [&](Index n) {
      if (exact_.is_given(mesh_.points[n])) unknown_[n] = given;
    };
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (mesh_.face_regions[f][0] != 0 && mesh_.face_regions[f][1] != 0) continue;
      for (const Index n : mesh_.faces[f]) mark(n);
      if (mesh_.order() == 2)
        for (const Index n : mesh_.face_mid_nodes[f]) mark(n);
    }
    for (int& u : unknown_)
      if (u == 0) u = count_++;
  }

  // Data at a quadrature point: its place, the Jacobian's determinant times the weight, and the shape
  // functions' gradients.
  struct Place {
    Point at;
    double weight;
    Eigen::MatrixXd gradients;
  };
  Place place(const std::vector<Index>& n, std::size_t q) const {
    const Shape& s = shapes_[q];
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < n.size(); ++i) {
      const Point& p = mesh_.points[n[i]];
      const Eigen::Vector3d x(p.x, p.y, p.z);
      const auto row = static_cast<Eigen::Index>(i);
      at += s.value(row) * x;
      jacobian += x * s.derivative.row(row);
    }
    return {{at.x(), at.y(), at.z()},
            points_[q].weight * jacobian.determinant() / 6,
            s.derivative * jacobian.inverse()};
  }

  void assemble() {
    std::vector<Eigen::Triplet<double>> entries;
    right_ = Eigen::VectorXd::Zero(count_);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const std::vector<Index> n = nodes(t);
      const auto size = static_cast<Eigen::Index>(n.size());
      Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
      Eigen::VectorXd load = Eigen::VectorXd::Zero(size);
      for (std::size_t q = 0; q < points_.size(); ++q) {
        const Place here = place(n, q);
        stiffness += here.weight * here.gradients * here.gradients.transpose();
        load += here.weight * exact_.load(here.at) * shapes_[q].value;
      }
      for (Eigen::Index i = 0; i < size; ++i) {
        const int row = unknown_[n[static_cast<std::size_t>(i)]];
        if (row < 0) continue;
        right_(row) += load(i);
        for (Eigen::Index j = 0; j < size; ++j) {
          const Index node = n[static_cast<std::size_t>(j)];
          if (unknown_[node] >= 0)
            entries.emplace_back(row, unknown_[node], stiffness(i, j));
          else
            right_(row) -= stiffness(i, j) * exact_.value(mesh_.points[node]);
        }
      }
    }
    matrix_.resize(count_, count_);
    matrix_.setFromTriplets(entries.begin(), entries.end());
  }

  PoissonErrors measure(const Eigen::VectorXd& found) const {
    double value = 0, gradient = 0, volume = 0;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const std::vector<Index> n = nodes(t);
      Eigen::VectorXd at_nodes(static_cast<Eigen::Index>(n.size()));
      for (std::size_t i = 0; i < n.size(); ++i)
        at_nodes(static_cast<Eigen::Index>(i)) =
            unknown_[n[i]] >= 0 ? found(unknown_[n[i]]) : exact_.value(mesh_.points[n[i]]);
      for (std::size_t q = 0; q < points_.size(); ++q) {
        const Place here = place(n, q);
        const double off = shapes_[q].value.dot(at_nodes) - exact_.value(here.at);
        const Vector g = exact_.gradient(here.at);
        const Eigen::Vector3d slope = here.gradients.transpose() * at_nodes - Eigen::Vector3d(g.x, g.y, g.z);
        value += here.weight * off * off;
        gradient += here.weight * slope.squaredNorm();
        volume += here.weight;
      }
    }
    return {std::sqrt(value), std::sqrt(gradient), std::cbrt(volume / static_cast<double>(mesh_.tets.size())),
            0, static_cast<std::size_t>(count_)};
  }

  double condition_number() const {
    const Eigen::SimplicialLDLT<Matrix> factors(matrix_);
    if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() <= 0)
      throw std::runtime_error("the stiffness matrix is not positive definite");
    return largest_eigenvalue([this](const auto& x) { return matrix_ * x; }) *
           largest_eigenvalue([&](const auto& x) { return factors.solve(x); });
  }

  // Returns the largest eigenvalue by power iteration, to a thousandth.
  template <class Apply>
  double largest_eigenvalue(const Apply& apply) const {
    Eigen::VectorXd x(count_);
    for (int i = 0; i < count_; ++i) x(i) = 1 + 0.5 * std::sin(1.7 * i);
    x.normalize();
    double value = 0;
    for (int step = 0; step < 2000; ++step) {
      const Eigen::VectorXd y = apply(x);
      const double next = y.norm();
      x = y / next;
      if (std::fabs(next - value) < 1e-5 * next) return next;
      value = next;
    }
    return value;
  }

  const TetMesh& mesh_;
  const Solution& exact_;
  std::vector<QuadraturePoint> points_;
  std::vector<Shape> shapes_;
  std::vector<int> unknown_;  // by node: its unknown; negative: none
  int count_ = 0;
  Matrix matrix_;
  Eigen::VectorXd right_;
};

}  // namespace

PoissonErrors solve_poisson(const TetMesh& mesh, const Solution& exact, bool with_condition_number) {
  return PoissonProblem(mesh, exact).solve(with_condition_number);
}

Solution smooth_solution() {
  return {[](const Point& p) { return std::sin(2 * p.x + 1) * std::cos(p.y) * std::exp(0.5 * p.z); },
          [](const Point& p) {
            const double s = std::sin(2 * p.x + 1), c = std::cos(2 * p.x + 1), e = std::exp(0.5 * p.z);
            return Vector{2 * c * std::cos(p.y) * e, -s * std::sin(p.y) * e, 0.5 * s * std::cos(p.y) * e};
          },
          [](const Point& p) {
            return (4 + 1 - 0.25) * std::sin(2 * p.x + 1) * std::cos(p.y) * std::exp(0.5 * p.z);
          }};
}

}  // namespace collarmesh::testing
