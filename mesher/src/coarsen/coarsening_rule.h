#pragma once

#include <algorithm>
#include <span>

#include "improve/shape_rule.h"

namespace collarmesh::coarsening {

using improvement::Corners;

/// The rule of coarsening: a tet of quality 1 or more is thin; its quality says how far its angles are within or beyond
/// these bounds. Whatever has an angle above the largest is worse than all that has none.
class CoarseningRule final : public improvement::ShapeRule {
 public:
  enum class Mode {
    final,  ///< new tets keep the guarantee: they are thin or within the radius-edge bound
    trial,  ///< they need not do so yet, but have edges between two lengths
    force   ///< they only have to have a volume; quality without the last sentence above
  };

  /// `thin` and `sizes`, by vertex, are kept by reference.
  CoarseningRule(const improvement::ThinShape& thin, double radius_edge, std::span<const double> sizes)
      : thin_(thin), bound_(radius_edge), sizes_(sizes) {}

  double quality(const Corners& p, const std::array<Index, 4>& corners) const override {
    const improvement::ExtremeAngles angles = improvement::extreme_angles(p);
    if (angles.smallest < 0) return -1;
    constexpr double largest = improvement::ThinShape::largest_angle - margin;
    const double blunt = (180 - angles.largest) / (180 - largest),
                 sharp = angles.smallest / (thin_.smallest_angle(corners) + margin);
    return blunt < 1 && mode_ != Mode::force ? beyond * blunt * std::min(1.0, sharp) : std::min(blunt, sharp);
  }
  bool allows(const Corners& p, const std::array<Index, 4>& corners, double quality) const override {
    if (mode_ == Mode::force) return true;
    if (mode_ == Mode::trial) return lengths_fit(p, corners);
    return keeps_guarantee(p, quality) && lengths_fit(p, corners);
  }
  bool dissolves_collars() const override { return true; }

  bool keeps_guarantee(const Corners& p, double quality) const { return quality >= 1 || bound_.holds(p); }

  Mode mode() const { return mode_; }
  void set_mode(Mode mode) { mode_ = mode; }
  /// Edges that operations make are at least so long, absolute, and at most this multiple of the target
  /// length between their ends.
  void limit_lengths(double shortest, double longest_relative) {
    squared_shortest_ = shortest * shortest;
    squared_longest_ = longest_relative * longest_relative;
  }
  /// Squared length of an edge by the target there.
  double squared_relative_length(double squared_length, Index a, Index b) const {
    const double target = 0.5 * (sizes_[a] + sizes_[b]);
    return squared_length / (target * target);
  }

 private:
  static constexpr double margin = 2 * improvement::ThinShape::rounding;
  static constexpr double beyond = 1e-6;

  bool lengths_fit(const Corners& p, const std::array<Index, 4>& corners) const {
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) {
        const double squared = squared_distance(p[i], p[j]);
        if (squared < squared_shortest_) return false;
        if (squared_relative_length(squared, corners[i], corners[j]) > squared_longest_) return false;
      }
    return true;
  }

  const improvement::ThinShape& thin_;
  improvement::RadiusEdgeBound bound_;
  std::span<const double> sizes_;
  Mode mode_ = Mode::final;
  double squared_shortest_ = 0, squared_longest_ = INFINITY;
};

}  // namespace collarmesh::coarsening
