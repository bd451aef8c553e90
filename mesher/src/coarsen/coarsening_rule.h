#pragma once

#include <algorithm>

#include "remesh/metric.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing::coarsening {

/// The rule of coarsening. A quality of 1 or more means that a tet keeps the bounds on thin tets; the quality
/// grows with the margins of its angles from these bounds. A tet with an angle above the largest permitted
/// one is worse than any tet without such an angle.
class CoarseningRule final : public AngleRule {
 public:
  enum class Mode {
    final,  ///< new tets keep the guarantee (see `keeps_guarantee`)
    trial,  ///< new tets need not keep the guarantee yet
    force   ///< as `trial`; angles above the largest permitted one and tets that the bounds on cells forbid
            ///< have no penalty in the quality
  };

  /// No operation makes an edge longer than this factor times the target length, unless the replaced edge was
  /// at least as long.
  static constexpr double longest_new = 1.5;

  /// Keeps references to the bounds and to the metric.
  CoarseningRule(const TetBounds& bounds, double radius_edge, const Metric& metric)
      : thin_(bounds.thin), cells_(bounds.cells), bound_(radius_edge), metric_(metric) {}

  double quality_of(const ExtremeCosines& cosines, const Corners& p,
                    const std::array<Index, 4>& corners) const override {
    const auto [of_smallest, of_largest] = thin_.squared_margins(cosines, p, corners);
    if (of_largest < 0) return -1;
    if (of_largest < 1 && mode_ != Mode::force)
      return beyond * std::sqrt(of_largest * std::min(1.0, of_smallest));
    const double quality = std::sqrt(std::min(of_largest, of_smallest));
    const bool fits = mode_ == Mode::force || !cells_.forbid_thin_tets() || cells_.allow(p, corners);
    return fits ? quality : CellBounds::forbidden * std::min(1.0, quality);
  }
  /// Returns true only if the tet's quality is above `quality`, which must be at least 1. Much cheaper than
  /// computing the quality, but returns false for some better tets, too.
  bool surely_exceeds(double quality, const Corners& p, const std::array<Index, 4>& corners) const {
    return !cells_.lacks_interior_node(corners) && thin_.surely_exceeds(quality, p);
  }
  bool allows(const Corners& p, const std::array<Index, 4>& corners, double quality) const override {
    return mode_ != Mode::final || keeps_guarantee(p, corners, quality);
  }
  bool allows_edge(Index a, Index b, const Vector& edge, const Vector& before) const override {
    return squared_norm(edge) <= squared_norm(before) || !metric_.exceeds(longest_new, a, b, edge);
  }
  // Returns a large share, because each move makes coarsening try the collapses around it again.
  double least_gain() const override { return 0.02; }
  unsigned step_lengths() const override { return 2; }
  bool dissolves_collars() const override { return true; }

  /// Returns whether the tet keeps the bounds on thin tets, or both the radius-edge bound and the bounds on
  /// cells. `quality`: its quality.
  bool keeps_guarantee(const Corners& p, const std::array<Index, 4>& corners, double quality) const {
    return quality >= 1 || (bound_.holds(p) && cells_.allow(p, corners));
  }

  void set_mode(Mode mode) { mode_ = mode; }

 private:
  static constexpr double beyond = 1e-6;

  const ThinShape& thin_;
  const CellBounds& cells_;
  RadiusEdgeBound bound_;
  const Metric& metric_;
  Mode mode_ = Mode::final;
};

}  // namespace collarmesh::remeshing::coarsening
