#pragma once

#include <algorithm>
#include <cassert>
#include <vector>

#include "shells/surface_complex.h"
#include "shells/triangle_shape.h"

namespace collarmesh::shells {

/// The triangles around a vertex, for trying many places before the vertex is moved.
class VertexFan {
 public:
  VertexFan(const SurfaceComplex& complex, Index vertex) : at_(complex.vertices[vertex].point) {
    sides_.reserve(complex.vertices[vertex].triangles.size());
    for (const Index t : complex.vertices[vertex].triangles) {
      const auto& c = complex.triangles[t].corners;
      const unsigned i = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
      sides_.push_back({complex.vertices[c[(i + 1) % 3]].point, complex.vertices[c[(i + 2) % 3]].point});
      normal_ = normal_ + area_vector({at_, sides_.back()[0], sides_.back()[1]});
    }
    const double length = norm(normal_);
    normal_ = length > 0 ? normal_ / length : Vector{};
    for (const auto& [a, b] : sides_) {
      centre_ = centre_ + (a - at_) / static_cast<double>(sides_.size());
      reach_ = std::max(reach_, distance(a, at_));
      if (const double squared = squared_norm(a - at_); squared > 0)
        bend_ += dot(a - at_, normal_) / squared / static_cast<double>(sides_.size());
    }
  }

  /// Returns the unit mean of the triangles' normals, weighted by areas; zero if there is none.
  const Vector& normal() const { return normal_; }
  /// Returns a unit vector orthogonal to the normal. Precondition: there is a normal.
  Vector across() const {
    const Vector& n = normal_;
    assert(dot(n, n) > 0);
    const Vector least = std::fabs(n.x) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    const Vector u = least - dot(least, n) * n;
    return u / norm(u);
  }
  /// Returns the vector from the vertex to the mean of its neighbours.
  const Vector& centre() const { return centre_; }
  /// Returns the distance to the farthest neighbour.
  double reach() const { return reach_; }
  /// Returns the place at this step from the vertex, on a surface as curved as the triangles are.
  Point place(const Vector& step) const {
    const Vector flat = step - dot(step, normal_) * normal_;
    return at_ + flat + bend_ * squared_norm(flat) * normal_;
  }

  /// Returns the least shape of the triangles if the vertex were at p; if that is below `bound`, any number
  /// below `bound`.
  double least_shape(const Point& p, double bound) const {
    double least = INFINITY;
    for (const auto& [a, b] : sides_)
      if ((least = std::min(least, shape_of({p, a, b}))) < bound) break;
    return least;
  }
  /// Returns the same as `least_shape`, but 0 if a triangle would be turned over.
  double least_turned_shape(const Point& p, double bound) const {
    for (const auto& [a, b] : sides_)
      if (!(dot(cross(a - p, b - p), normal_) > 0)) return 0;
    return least_shape(p, bound);
  }

 private:
  Point at_;
  std::vector<std::array<Point, 2>> sides_;
  Vector normal_{}, centre_{};
  double reach_ = 0, bend_ = 0;
};

}  // namespace collarmesh::shells
