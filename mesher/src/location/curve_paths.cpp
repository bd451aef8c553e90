#include "location/curve_paths.h"

#include <algorithm>

#include "common/segments.h"

namespace collarmesh {

CurvePaths::CurvePaths(const Plc& plc, std::span<const Point> points) : plc_(plc), points_(points) {
  for (const Plc::Curve& curve : plc.curves) {
    std::vector<double> lengths{0};
    visit_segments(curve, [&](Index a, Index b) {
      lengths.push_back(lengths.back() + distance(points_[a], points_[b]));
    });
    lengths_.push_back(std::move(lengths));
  }
}

double CurvePaths::wrapped(Index curve, double parameter) const {
  if (!plc_.curves[curve].closed) return parameter;
  return parameter - length(curve) * std::floor(parameter / length(curve));
}

std::size_t CurvePaths::segment(Index curve, double parameter) const {
  const auto& lengths = lengths_[curve];
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(lengths, wrapped(curve, parameter)) -
                                              lengths.begin());
  return std::clamp<std::size_t>(after, 1, lengths.size() - 1) - 1;
}

std::array<Index, 2> CurvePaths::segment_ends(Index curve, std::size_t segment) const {
  const auto& p = plc_.curves[curve].points;
  return {p[segment], p[(segment + 1) % p.size()]};
}

Point CurvePaths::point(Index curve, double parameter) const {
  const auto& lengths = lengths_[curve];
  const std::size_t i = segment(curve, parameter);
  const double step = lengths[i + 1] - lengths[i];
  const double t = step > 0 ? std::clamp((wrapped(curve, parameter) - lengths[i]) / step, 0.0, 1.0) : 0;
  const auto [a, b] = segment_ends(curve, i);
  return points_[a] + t * (points_[b] - points_[a]);
}

}  // namespace collarmesh
