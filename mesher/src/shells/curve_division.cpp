#include "shells/curve_division.h"

#include <algorithm>
#include <cmath>

#include "common/distances.h"

namespace collarmesh::shells {

namespace {

// A number of edges that is so much too small is not rounded up: edges are longer by a third at most.
constexpr double rounding = 0.3;

/// The number of target edge lengths along a curve, by arc length.
class EdgesAlong {
 public:
  EdgesAlong(const CurvePaths& paths, const SurfaceSizes& sizes, Index curve) {
    constexpr double least_step = 1e-4, steps_per_size = 8;  // of the length
    const double length = paths.length(curve);
    double at = 0, count = 0, size = sizes.on_curve(curve, 0);
    lengths_.push_back(0);
    counts_.push_back(0);
    while (at < length) {
      const double step = std::clamp(size / steps_per_size, least_step * length, length - at);
      const double next = step < least_step * length || at + step >= length ? length : at + step;
      const double next_size = sizes.on_curve(curve, next);
      count += 0.5 * (next - at) * (1 / size + 1 / next_size);
      at = next;
      size = next_size;
      lengths_.push_back(at);
      counts_.push_back(count);
    }
  }

  double total() const { return counts_.back(); }
  /// The arc length before which there are so many.
  double at(double count) const {
    const auto after =
        static_cast<std::size_t>(std::lower_bound(counts_.begin(), counts_.end(), count) - counts_.begin());
    if (after == 0) return 0;
    if (after == counts_.size()) return lengths_.back();
    const double share = (count - counts_[after - 1]) / (counts_[after] - counts_[after - 1]);
    return lengths_[after - 1] + share * (lengths_[after] - lengths_[after - 1]);
  }

 private:
  std::vector<double> lengths_, counts_;
};

bool shares_both_ends(const Plc& plc, Index curve) {
  const Index a = plc.curves[curve].ends[0], b = plc.curves[curve].ends[1];
  return std::any_of(plc.vertices[a].curves.begin(), plc.vertices[a].curves.end(), [&](Index other) {
    const auto& ends = plc.curves[other].ends;
    return other != curve && (ends[0] == b || ends[1] == b) && (ends[0] == a || ends[1] == a);
  });
}

double least_count(const Plc& plc, Index curve) {
  const Plc::Curve& c = plc.curves[curve];
  if (c.closed || c.ends[0] == c.ends[1]) return 3;
  return !c.straight && shares_both_ends(plc, curve) ? 2 : 1;
}

}  // namespace

double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to) {
  const Plc::Curve& c = plc.curves[curve];
  const std::vector<double>& lengths = paths.lengths(curve);
  const double length = lengths.back();
  const Point a = paths.point(curve, from), b = paths.point(curve, to);
  double most = 0;
  for (double shift = c.closed ? length * std::floor(from / length) : 0; shift < to; shift += length) {
    auto at = std::upper_bound(lengths.begin(), lengths.end(), from - shift);
    for (; at != lengths.end() && *at + shift < to; ++at) {
      const Index point = c.points[static_cast<std::size_t>(at - lengths.begin()) % c.points.size()];
      most = std::max(most, distance_to_segment(plc.points[point], a, b) / tolerance.at_point(point));
    }
    if (!c.closed) break;
  }
  return most;
}

std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance,
                                 const SurfaceSizes& sizes, Index curve) {
  const EdgesAlong along(paths, sizes, curve);
  const double least = least_count(plc, curve), count = std::max(least, std::ceil(along.total() - rounding));
  std::vector<double> at;
  for (double i = count; i >= 0; --i) at.push_back(along.at(along.total() * i / count));
  at.front() = paths.length(curve);
  at.back() = 0;
  std::vector<double> divided;
  const double shortest = 1e-6 * paths.length(curve);
  while (!at.empty()) {  // from the first to the last, halved where they are too far from the curve
    const double next = at.back();
    if (!divided.empty() && next - divided.back() > shortest &&
        sag_between(plc, paths, tolerance, curve, divided.back(), next) > 1) {
      at.push_back(0.5 * (divided.back() + next));
      continue;
    }
    divided.push_back(next);
    at.pop_back();
  }
  return divided;
}

}  // namespace collarmesh::shells
