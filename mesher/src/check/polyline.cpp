#include "check/polyline.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/distances.h"

namespace collarmesh::checks {

NearestOnSegment nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Vector ab = b - a;
  const double t = parameter_on_segment(p, a, b);
  // Measures from the nearer end, which is exact if p is that end.
  return {t < 0.5 ? norm((p - a) - t * ab) : norm((p - b) + (1 - t) * ab), t};
}

Polyline::Polyline(std::vector<Point> points) : points_(std::move(points)), arc_(1, 0) {
  for (std::size_t i = 1; i < points_.size(); ++i)
    arc_.push_back(arc_.back() + distance(points_[i - 1], points_[i]));
  assert(points_.size() >= 2);
}

std::size_t Polyline::segment_at(double arc) const {
  const auto after = std::upper_bound(arc_.begin(), arc_.end(), arc);
  const auto i = static_cast<std::size_t>(after - arc_.begin());
  return std::clamp<std::size_t>(i, 1, points_.size() - 1) - 1;
}

Point Polyline::at(double arc) const {
  const std::size_t i = segment_at(arc);
  const double length = arc_[i + 1] - arc_[i];
  const double t = length > 0 ? std::clamp((arc - arc_[i]) / length, 0.0, 1.0) : 0;
  return points_[i] + t * (points_[i + 1] - points_[i]);
}

Polyline::Nearest Polyline::nearest(const Point& p, double from, double to) const {
  Nearest best{from, INFINITY};
  for (std::size_t i = segment_at(from); i + 1 < points_.size() && arc_[i] <= to; ++i) {
    auto [d, t] = nearest_on_segment(p, points_[i], points_[i + 1]);
    double arc = arc_[i] + t * (arc_[i + 1] - arc_[i]);
    if (arc < from || arc > to) {
      arc = std::clamp(arc, from, to);
      d = distance(p, at(arc));
    }
    if (d < best.distance) best = {arc, d};
  }
  return best;
}

Polyline::Range Polyline::corners_between(double from, double to) const {
  const auto first = std::upper_bound(arc_.begin(), arc_.end(), from);
  const auto last = std::lower_bound(first, arc_.end(), to);
  return {static_cast<std::size_t>(first - arc_.begin()), static_cast<std::size_t>(last - arc_.begin())};
}

Polyline Polyline::started_at(double arc) const {
  const std::size_t segment = segment_at(arc);
  std::vector<Point> points{at(arc)};
  points.insert(points.end(), points_.begin() + static_cast<std::ptrdiff_t>(segment) + 1, points_.end());
  points.insert(points.end(), points_.begin() + 1,
                points_.begin() + static_cast<std::ptrdiff_t>(segment) + 1);
  points.push_back(points.front());
  return Polyline(std::move(points));
}

}  // namespace collarmesh::checks
