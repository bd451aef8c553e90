// The sign of the Jacobian determinant over a whole tetrahedron of second order.
#include "collarmesh/curved_tet.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "common/cell_shapes.h"
#include "mesh/orientation.h"

namespace collarmesh {

namespace {

constexpr double epsilon = 0x1p-52;

/// A cubic polynomial on a tetrahedron as its blossom, a symmetric form in three points: at(i, j, k) is the
/// Bernstein coefficient of the corners i, j, k, and at(i, i, i) the value at corner i.
class Cubic {
 public:
  double& at(unsigned i, unsigned j, unsigned k) { return coefficients_[16 * i + 4 * j + k]; }
  double at(unsigned i, unsigned j, unsigned k) const { return coefficients_[16 * i + 4 * j + k]; }

  double least_coefficient() const { return *std::min_element(coefficients_.begin(), coefficients_.end()); }
  double least_corner() const { return std::min({at(0, 0, 0), at(1, 1, 1), at(2, 2, 2), at(3, 3, 3)}); }

  /// Returns the polynomial on the half whose corner `moved` is the middle of the edge to `other`.
  Cubic half(unsigned moved, unsigned other) const {
    Cubic c = *this;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < 4; ++j) c.at(moved, i, j) = 0.5 * (c.at(moved, i, j) + c.at(other, i, j));
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < 4; ++j) c.at(i, moved, j) = 0.5 * (c.at(i, moved, j) + c.at(i, other, j));
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < 4; ++j) c.at(i, j, moved) = 0.5 * (c.at(i, j, moved) + c.at(i, j, other));
    return c;
  }

 private:
  std::array<double, 64> coefficients_{};
};

/// A part of the tetrahedron: the polynomial there and the corners in barycentric coordinates.
struct Part {
  Cubic cubic;
  std::array<std::array<double, 4>, 4> corners;

  EdgePlaces longest_edge() const {
    EdgePlaces longest = cell_shapes::tet_edges[0];
    double length = 0;
    for (const auto& [i, j] : cell_shapes::tet_edges) {
      double squared = 0;
      for (unsigned k = 0; k < 4; ++k)
        squared += (corners[i][k] - corners[j][k]) * (corners[i][k] - corners[j][k]);
      if (squared <= length) continue;
      length = squared;
      longest = {i, j};
    }
    return longest;
  }
  Part half(unsigned moved, unsigned other) const {
    Part part{cubic.half(moved, other), corners};
    for (unsigned k = 0; k < 4; ++k) part.corners[moved][k] = 0.5 * (corners[moved][k] + corners[other][k]);
    return part;
  }
};

double determinant(const Vector& a, const Vector& b, const Vector& c) { return dot(cross(a, b), c); }

bool is_straight(const CurvedTet& p) {
  for (std::size_t e = 0; e < 6; ++e) {
    const Point &a = p[cell_shapes::tet_edges[e][0]], &b = p[cell_shapes::tet_edges[e][1]], &m = p[4 + e];
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (std::fabs(m[axis] - 0.5 * (a[axis] + b[axis])) >
          2 * epsilon * std::max(std::fabs(a[axis]), std::fabs(b[axis])))
        return false;
  }
  return true;
}

// Returns the Jacobian determinant as a cubic polynomial. With Bezier points c_ij (c_ii the corners, c_ij = 2
// m_ij - (p_i + p_j) / 2 for an edge), the derivative along edge 0k is the linear function 2 sum_i l_i d_ik,
// d_ik = c_ik - c_i0. The determinant of three such derivatives is a cubic. Its blossom is the mean over the
// ways to assign three points to three linear functions.
Cubic jacobian(const CurvedTet& p, double& error) {
  std::array<std::array<Point, 4>, 4> bezier;
  for (std::size_t i = 0; i < 4; ++i) bezier[i][i] = p[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = cell_shapes::tet_edges[e];
    bezier[i][j] = bezier[j][i] = 2 * p[4 + e] - 0.5 * (p[i] + p[j]);
  }
  std::array<std::array<Vector, 4>, 3> d;
  double longest = 0, largest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      d[k][i] = bezier[i][k + 1] - bezier[i][0];
      longest = std::max(longest, norm(d[k][i]));
    }
  for (const Point& point : p)
    for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max(largest, std::fabs(point[axis]));
  Cubic cubic;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < 4; ++j)
      for (unsigned k = 0; k < 4; ++k) {
        double sum = 0;
        for (const auto& [u, v, w] : {std::array{i, j, k}, std::array{i, k, j}, std::array{j, i, k},
                                      std::array{j, k, i}, std::array{k, i, j}, std::array{k, j, i}})
          sum += determinant(d[0][u], d[1][v], d[2][w]);
        cubic.at(i, j, k) = 8.0 / 6 * sum;
      }
  // Rounding: a coordinate of a difference of Bezier points is off by at most 10 epsilon times the largest
  // coordinate, and the difference by at most 20. A determinant is off by at most three such errors times the
  // square of the longest difference, plus its own rounding.
  error = 8 * epsilon * longest * longest * (60 * largest + 20 * longest);
  return cubic;
}

}  // namespace

CurvedTet curved_tet(const TetMesh& mesh, Index tet) {
  assert(mesh.order() == 2);
  CurvedTet nodes;
  for (std::size_t k = 0; k < 4; ++k) nodes[k] = mesh.points[mesh.tets[tet][k]];
  for (std::size_t k = 0; k < 6; ++k) nodes[4 + k] = mesh.points[mesh.tet_mid_nodes[tet][k]];
  return nodes;
}

bool jacobian_exceeds(const CurvedTet& nodes, double least) {
  assert(least >= 0 && least < 1);
  if (is_straight(nodes)) return exact_orientation(nodes[0], nodes[1], nodes[2], nodes[3]) > 0;
  double error = 0;
  std::vector<Part> open(1);
  open[0].cubic = jacobian(nodes, error);
  for (std::size_t k = 0; k < 4; ++k) open[0].corners[k][k] = 1;
  const double bound = least * std::max(0.0, six_volume(nodes[0], nodes[1], nodes[2], nodes[3])) + error;
  constexpr std::size_t most_parts = 20000;  // limit for polynomials that touch the bound inside the tet,
                                             // which bisection never decides
  for (std::size_t parts = 0; !open.empty(); ++parts) {
    const Part part = open.back();
    open.pop_back();
    if (part.cubic.least_coefficient() > bound) continue;
    if (part.cubic.least_corner() <= bound || parts > most_parts) return false;
    const auto [i, j] = part.longest_edge();
    open.push_back(part.half(i, j));
    open.push_back(part.half(j, i));
  }
  return true;
}

}  // namespace collarmesh
