#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"
#include "location/centred_box.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace collarmesh {

/// Segments in one neighbourhood, prepared for tests against many boxes: by separating axes as in
/// SegmentAgainstBoxes, four segments at a time. Works in single precision relative to the neighbourhood.
/// Conservative: boxes are widened by more than the rounding errors, so that no box that a segment meets is
/// missed.
class SegmentBundle {
 public:
  /// A set of segments of one part of the bundle; bit i stands for segment i of the part.
  using Mask = std::uint64_t;
  /// The number of segments in a part; the last part may have fewer.
  static constexpr std::size_t part_size = 64;

  /// Starts a new bundle. All points must lie in the ball B(centre, radius). Precondition: radius > 0.
  void start(const Point& centre, double radius) {
    assert(radius > 0);
    centre_ = centre;
    scale_ = 1 / radius;
    points_.clear();
    relative_.clear();
    segments_.clear();
    groups_.clear();
  }

  /// Adds a point. Points are numbered from 0.
  void add_point(const Point& p) {
    points_.push_back(p);
    const Vector d = scale_ * (p - centre_);
    relative_.push_back(Lanes{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), 0});
  }
  /// Adds a segment. Segments are numbered from 0, too.
  void add_segment(Index from, Index to) {
    const std::size_t lane = segments_.size() % lane_count;
    if (lane == 0) groups_.push_back({});
    segments_.push_back({from, to});
    const Lanes middle = 0.5F * (relative_[from] + relative_[to]),
                half = 0.5F * (relative_[to] - relative_[from]);
    Group& group = groups_.back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      group.middle[axis][lane] = middle[axis];
      group.half[axis][lane] = half[axis];
    }
  }

  const Point& from(Index segment) const { return points_[segments_[segment][0]]; }
  const Point& to(Index segment) const { return points_[segments_[segment][1]]; }
  std::size_t part_count() const { return (segments_.size() + part_size - 1) / part_size; }
  /// Returns the mask of all segments of a part.
  Mask all(std::size_t part) const {
    const std::size_t count = std::min(part_size, segments_.size() - part * part_size);
    return ~Mask{0} >> (part_size - count);
  }

  /// Returns which of the `candidates` may meet the box.
  Mask may_meet(const CentredBox& box, std::size_t part, Mask candidates) const {
    std::array<Lanes, 3> c, e;
    const Vector centre = scale_ * (box.centre - centre_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double half = scale_ * box.half[axis];
      c[axis] = all_lanes(static_cast<float>(centre[axis]));
      e[axis] = all_lanes(static_cast<float>(half + slack * (1 + half)));
    }
    Mask found = 0;
    const Group* group = groups_.data() + part * (part_size / lane_count);
    for (unsigned first = 0; first < part_size && candidates >> first != 0; first += lane_count, ++group)
      if (candidates >> first & lanes_of_a_group) found |= Mask{meeting(*group, c, e)} << first;
    return found & candidates;
  }

 private:
  static constexpr std::size_t lane_count = 4;
  static constexpr Mask lanes_of_a_group = 15;
  // Bound on rounding. Numbers in single precision have a relative error of 6e-8. The points are at most 1
  // from the centre, so their error is at most 6e-8. For a box whose longest side is 2 `half`, the tests err
  // by at most a few times 6e-8 (1 + `half`).
  static constexpr double slack = 4e-6;
  using Lanes [[gnu::vector_size(lane_count * sizeof(float))]] = float;
  using Truths [[gnu::vector_size(lane_count * sizeof(float))]] = std::int32_t;
  struct Group {
    std::array<Lanes, 3> middle, half;  // by axis
  };
  static Lanes all_lanes(float value) { return Lanes{value, value, value, value}; }
  static Lanes magnitude(const Lanes& a) {
    return reinterpret_cast<Lanes>(reinterpret_cast<Truths>(a) & 0x7fffffff);
  }
  static unsigned bits(const Truths& truths) {
#if defined(__SSE2__)
    return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(truths)));
#else
    unsigned all = 0;
    for (unsigned lane = 0; lane < lane_count; ++lane) all |= (truths[lane] != 0 ? 1U : 0U) << lane;
    return all;
#endif
  }

  static unsigned meeting(const Group& group, const std::array<Lanes, 3>& c, const std::array<Lanes, 3>& e) {
    const auto& h = group.half;
    const std::array<Lanes, 3> m{c[0] - group.middle[0], c[1] - group.middle[1], c[2] - group.middle[2]};
    const std::array<Lanes, 3> r{magnitude(h[0]), magnitude(h[1]), magnitude(h[2])};
    const Truths overlap = (magnitude(m[0]) <= e[0] + r[0]) & (magnitude(m[1]) <= e[1] + r[1]) &
                           (magnitude(m[2]) <= e[2] + r[2]);
    const unsigned near = bits(overlap);
    if (near == 0) return 0;
    const Truths crossing = (magnitude(m[1] * h[2] - m[2] * h[1]) <= e[1] * r[2] + e[2] * r[1]) &
                            (magnitude(m[2] * h[0] - m[0] * h[2]) <= e[2] * r[0] + e[0] * r[2]) &
                            (magnitude(m[0] * h[1] - m[1] * h[0]) <= e[0] * r[1] + e[1] * r[0]);
    return near & bits(crossing);
  }

  Point centre_;
  double scale_ = 1;
  std::vector<Point> points_;
  std::vector<Lanes> relative_;
  std::vector<std::array<Index, 2>> segments_;
  std::vector<Group> groups_;
};

}  // namespace collarmesh
