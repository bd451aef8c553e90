#include "shells/curve_division.h"

#include <algorithm>
#include <cmath>

#include "common/distances.h"

namespace collarmesh::shells {

namespace {

/// A counter of target edge lengths along a curve.
class EdgesAlong {
 public:
  EdgesAlong(const std::function<double(double)>& size_at, double from, double to) {
    constexpr double least_step = 1e-4, steps_per_size = 8;  // `least_step` is relative to the length
    const double length = to - from;
    double at = from, count = 0, size = size_at(from);
    places_.push_back(from);
    counts_.push_back(0);
    while (at < to) {
      const double step = std::max(size / steps_per_size, least_step * length);
      const double next = at + step >= to ? to : at + step;
      const double next_size = size_at(next);
      count += 0.5 * (next - at) * (1 / size + 1 / next_size);
      at = next;
      size = next_size;
      places_.push_back(at);
      counts_.push_back(count);
    }
  }

  double total() const { return counts_.back(); }
  /// Returns the place at which the count reaches this number.
  double at(double count) const {
    const auto after =
        static_cast<std::size_t>(std::lower_bound(counts_.begin(), counts_.end(), count) - counts_.begin());
    if (after == 0) return places_.front();
    if (after == counts_.size()) return places_.back();
    const double share = (count - counts_[after - 1]) / (counts_[after] - counts_[after - 1]);
    return places_[after - 1] + share * (places_[after] - places_[after - 1]);
  }

 private:
  std::vector<double> places_, counts_;
};

bool shares_both_ends(const Plc& plc, Index curve) {
  const Index a = plc.curves[curve].ends[0], b = plc.curves[curve].ends[1];
  return std::any_of(plc.vertices[a].curves.begin(), plc.vertices[a].curves.end(), [&](Index other) {
    const auto& ends = plc.curves[other].ends;
    return other != curve && (ends[0] == b || ends[1] == b) && (ends[0] == a || ends[1] == a);
  });
}

}  // namespace

double least_edge_count(const Plc& plc, Index curve) {
  const Plc::Curve& c = plc.curves[curve];
  if (c.closed || c.ends[0] == c.ends[1]) return 3;
  return !c.straight && shares_both_ends(plc, curve) ? 2 : 1;
}

double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to) {
  return sag_between(
      plc, paths, [&](Index point) { return tolerance.at_point(point); }, curve, from, to);
}

double sag_between(const Plc& plc, const CurvePaths& paths, const SagLimit& limit, Index curve, double from,
                   double to) {
  const Plc::Curve& c = plc.curves[curve];
  const std::vector<double>& lengths = paths.lengths(curve);
  const double length = lengths.back();
  const Point a = paths.point(curve, from), b = paths.point(curve, to);
  double most = 0;
  for (double shift = c.closed ? length * std::floor(from / length) : 0; shift < to; shift += length) {
    auto at = std::upper_bound(lengths.begin(), lengths.end(), from - shift);
    for (; at != lengths.end() && *at + shift < to; ++at) {
      const Index point = c.points[static_cast<std::size_t>(at - lengths.begin()) % c.points.size()];
      most = std::max(most, distance_to_segment(plc.points[point], a, b) / limit(point));
    }
    if (!c.closed) break;
  }
  return most;
}

std::vector<double> divide_by_size(const std::function<double(double)>& size, double from, double to,
                                   double least_count, double rounding) {
  const EdgesAlong along(size, from, to);
  const double count = std::max(least_count, std::ceil(along.total() - rounding));
  std::vector<double> places{from};
  for (double i = 1; i < count; ++i) places.push_back(along.at(along.total() * i / count));
  places.push_back(to);
  return places;
}

std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SagLimit& limit,
                                 const SurfaceSizes& sizes, Index curve, const std::array<double, 2>& tips) {
  const double length = paths.length(curve), shortest = 1e-6 * length;
  constexpr double rounding = 0.3;  // edges exceed the size by at most 30%
  const double from = tips[0], to = length - tips[1];
  const double of_tips = (tips[0] > 0 ? 1 : 0) + (tips[1] > 0 ? 1 : 0);
  std::vector<double> at;
  if (to - from > shortest)
    at = divide_by_size([&](double place) { return sizes.on_curve(curve, place); }, from, to,
                        std::max(1.0, least_edge_count(plc, curve) - of_tips), rounding);
  else
    at = {from};
  if (tips[0] > 0) at.insert(at.begin(), 0);
  if (tips[1] > 0) at.push_back(length);
  at.back() = length;
  std::reverse(at.begin(), at.end());
  std::vector<double> divided;
  while (!at.empty()) {  // goes through the intervals and halves those that are too far from the curve
    const double next = at.back();
    const bool tip = (tips[0] > 0 && divided.size() == 1) || (tips[1] > 0 && at.size() == 1);
    if (!divided.empty() && !tip && next - divided.back() > shortest &&
        sag_between(plc, paths, limit, curve, divided.back(), next) > 1) {
      at.push_back(0.5 * (divided.back() + next));
      continue;
    }
    divided.push_back(next);
    at.pop_back();
  }
  return divided;
}

}  // namespace collarmesh::shells
