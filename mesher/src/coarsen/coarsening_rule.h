#pragma once

#include <algorithm>

#include "remesh/metric.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing::coarsening {

/// The rule of coarsening. A tet of quality 1 or more keeps the bounds on thin tets; its quality tells how
/// far its angles are within or beyond these bounds. A tet with an angle above the largest one allowed is
/// worse than any tet without.
class CoarseningRule final : public AngleRule {
 public:
  enum class Mode {
    final,  ///< new tets keep the guarantee: they are thin or within the radius-edge bound
    trial,  ///< new tets need not keep the guarantee yet
    force   ///< new tets only need positive volume; quality does not single out tets with an angle above the
            ///< largest one, nor tets that the bounds on cells forbid
  };

  /// No operation makes an edge longer than this factor times the target length, unless the edge that it
  /// replaces was as long.
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
  /// Returns whether the quality is above this value, which is at least 1. Much cheaper than the quality; may
  /// return false for some tets above it.
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
