#include "common/round_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/segments.h"

namespace collarmesh {

namespace {

// The polyline of a half circle turns by at least this angle (radians).
constexpr double least_turn = 0.85 * std::numbers::pi;

}  // namespace

double length_of(const Plc& plc, const Plc::Curve& curve) {
  double length = 0;
  visit_segments(curve, [&](Index a, Index b) { length += distance(plc.points[a], plc.points[b]); });
  return length;
}

std::size_t least_edges(const Plc& plc, const Plc::Curve& curve, double edges_per_circle) {
  if (curve.straight || !(edges_per_circle > 0)) return 0;
  const auto& p = curve.points;
  const std::size_t count = p.size();
  const auto point = [&](std::size_t i) { return plc.points[p[i % count]]; };
  double turn = 0;
  for (std::size_t i = curve.closed ? 0 : 1; i + (curve.closed ? 0 : 1) < count; ++i) {
    const Vector u = point(i) - point(i + count - 1), v = point(i + 1) - point(i);
    turn += std::atan2(norm(cross(u, v)), dot(u, v));
  }
  if (turn < least_turn) return 0;
  const double circles = std::min(1.0, turn / (2 * std::numbers::pi));
  return static_cast<std::size_t>(std::lround(std::ceil(edges_per_circle * circles - 0.1)));
}

}  // namespace collarmesh
