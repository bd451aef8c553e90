#include "tolerance/curvature.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "common/edge_key.h"

namespace collarmesh {

namespace {

// The curvature tensor of one smooth patch, averaged around each of its points.
class PatchCurvature {
 public:
  PatchCurvature(const Plc& plc, const Plc::Patch& patch) : plc_(plc), patch_(patch) {
    for (Index i = 0; i < patch.triangle_count; ++i) {
      const auto& t = triangle(i);
      const Vector n = normal(t);
      const double doubled = norm(n);
      for (const Index p : t) at(p).area += doubled / 6;
      for (unsigned k = 0; k < 3; ++k) add_edge(t[k], t[(k + 1) % 3], doubled > 0 ? n / doubled : n);
    }
  }

  /// Returns the curvatures of each triangle: the maximum of `largest` and the mean of `sum` at its corners.
  std::vector<Curvature> by_triangle() const {
    std::vector<AtPoint> smooth(points_.size());
    for (Index i = 0; i < patch_.triangle_count; ++i) {
      AtPoint sum;
      for (const Index p : triangle(i)) sum.add(points_[number_.at(p)]);
      for (const Index p : triangle(i)) smooth[number_.at(p)].add(sum);
    }
    std::vector<Curvature> at_points;
    at_points.reserve(smooth.size());
    for (const AtPoint& p : smooth) at_points.push_back(curvature(p));
    std::vector<Curvature> result;
    for (Index i = 0; i < patch_.triangle_count; ++i) {
      Curvature& of_triangle = result.emplace_back();
      for (const Index p : triangle(i)) {
        const Curvature& c = at_points[number_.at(p)];
        of_triangle.largest = std::max(of_triangle.largest, c.largest);
        of_triangle.sum += c.sum / 3;
      }
    }
    return result;
  }

 private:
  struct AtPoint {
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    double area = 0;

    void add(const AtPoint& other) {
      tensor += other.tensor;
      area += other.area;
    }
  };

  const std::array<Index, 3>& triangle(Index i) const {
    return plc_.triangles[patch_.first_triangle + i].points;
  }
  Vector normal(const std::array<Index, 3>& t) const {
    return cross(plc_.points[t[1]] - plc_.points[t[0]], plc_.points[t[2]] - plc_.points[t[0]]);
  }
  AtPoint& at(Index point) {
    const auto [entry, fresh] = number_.try_emplace(point, points_.size());
    if (fresh) points_.emplace_back();
    return points_[entry->second];
  }

  // Adds an edge of a triangle with the unit normal n. The bend of the edge is known, and added to its ends,
  // when the second triangle at the edge comes.
  void add_edge(Index a, Index b, const Vector& n) {
    const auto [entry, fresh] = normal_at_.try_emplace(edge_key(a, b), n);
    if (fresh) return;
    const Vector edge = plc_.points[b] - plc_.points[a];
    const double length = norm(edge);
    if (length == 0) return;
    const double turn = std::atan2(dot(cross(entry->second, n), edge) / length, dot(entry->second, n));
    const Eigen::Vector3d e(edge.x / length, edge.y / length, edge.z / length);
    for (const Index p : {a, b}) at(p).tensor += 0.5 * turn * length * e * e.transpose();
  }

  static Curvature curvature(const AtPoint& p) {
    if (!(p.area > 0)) return {};
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(p.tensor / p.area, Eigen::EigenvaluesOnly);
    return {solver.eigenvalues().cwiseAbs().maxCoeff(), p.tensor.trace() / p.area};
  }

  const Plc& plc_;
  const Plc::Patch& patch_;
  std::unordered_map<Index, std::size_t> number_;
  std::vector<AtPoint> points_;
  std::unordered_map<std::uint64_t, Vector> normal_at_;  // by edge: the first triangle's normal
};

// Returns for each segment of a curve the larger curvature of its ends.
std::vector<double> largest_by_segment(const Plc& plc, const Plc::Curve& curve) {
  const auto& p = curve.points;
  const std::size_t count = p.size(), segments = curve.closed ? count : count - 1;
  const auto point = [&](std::size_t i) { return plc.points[p[i % count]]; };
  std::vector<double> curvature(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (!curve.closed && (i == 0 || i + 1 == count)) continue;
    const Vector u = point(i) - point(i + count - 1), v = point(i + 1) - point(i);
    const double length = 0.5 * (norm(u) + norm(v));
    if (length > 0) curvature[i] = std::atan2(norm(cross(u, v)), dot(u, v)) / length;
  }
  if (!curve.closed && count > 2) {
    curvature.front() = curvature[1];
    curvature.back() = curvature[count - 2];
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < segments; ++i)
    result.push_back(std::max(curvature[i], curvature[(i + 1) % count]));
  return result;
}

}  // namespace

std::vector<Curvature> curvatures(const Plc& plc, const Plc::Patch& patch) {
  return PatchCurvature(plc, patch).by_triangle();
}

CurvatureSizes curvature_sizes(const Plc& plc, double elements_per_circle) {
  const auto size = [&](double curvature) {
    return curvature > 0 ? 2 * std::numbers::pi / (curvature * elements_per_circle) : INFINITY;
  };
  CurvatureSizes sizes;
  sizes.triangle.assign(plc.triangles.size(), INFINITY);
  for (const Plc::Patch& patch : plc.patches) {
    if (patch.planar) continue;
    const std::vector<Curvature> curvature = curvatures(plc, patch);
    for (Index i = 0; i < patch.triangle_count; ++i)
      sizes.triangle[patch.first_triangle + i] = size(curvature[i].largest);
  }
  for (const Plc::Curve& curve : plc.curves) {
    auto& segments = sizes.curve_segment.emplace_back();
    if (curve.straight) continue;
    for (const double curvature : largest_by_segment(plc, curve)) segments.push_back(size(curvature));
  }
  return sizes;
}

}  // namespace collarmesh
