#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// How far a mesh may be from the smooth patches and curves of a complex, by place. Lengths are absolute.
/// Copies share what they hold.
class SurfaceTolerance {
 public:
  /// The same everywhere.
  explicit SurfaceTolerance(double distance) : largest_(distance) {}
  /// By triangle of the complex; none of them exceeds `largest`.
  SurfaceTolerance(const Plc& plc, std::vector<double> triangles, double largest);

  /// Is it not the same everywhere?
  bool varies() const { return places_ != nullptr; }
  double largest() const { return share_ * largest_; }
  double at_triangle(Index triangle) const {
    return share_ * (varies() ? places_->triangles[triangle] : largest_);
  }
  /// At a point of the complex: the smallest of the triangles there.
  double at_point(Index point) const { return share_ * (varies() ? places_->points[point] : largest_); }
  /// On the segment between two neighbouring points of a curve.
  double at_segment(Index a, Index b) const { return std::min(at_point(a), at_point(b)); }
  /// The smallest at points of a patch, and the largest of its triangles.
  double least_on_patch(Index patch) const {
    return share_ * (varies() ? places_->least_on_patch[patch] : largest_);
  }
  double largest_on_patch(Index patch) const {
    return share_ * (varies() ? places_->largest_on_patch[patch] : largest_);
  }
  /// The smallest and the largest on a curve's segments.
  double least_on_curve(const Plc::Curve& curve) const;
  double largest_on_curve(const Plc::Curve& curve) const;
  /// A share of it, everywhere.
  SurfaceTolerance scaled(double share) const {
    SurfaceTolerance scaled = *this;
    scaled.share_ *= share;
    return scaled;
  }
  /// The same for a complex that has only some of the patches of `whole`, these in this order, and all
  /// points.
  SurfaceTolerance of_patches(const Plc& whole, std::span<const Index> patches) const;

 private:
  struct Places {
    std::vector<double> triangles, points, least_on_patch, largest_on_patch;
  };

  std::shared_ptr<const Places> places_;
  double largest_, share_ = 1;
};

/// The tolerance of a run that asks for no distance: a tenth of the target edge length (`size`, 0: its
/// default), at most 1/200 of the diagonal, and at most a share of what is there: of the thickness of the
/// material on either side, so that it keeps its volume, and of the width of gaps and holes. Opposite sides
/// of a wall that bend alike lose and gain the same, so they may be farther off than those of a rod, which
/// lose both. With elements of second order the triangles between corners may be farther off, as the
/// elements follow the surface. Cost: near linear in the triangles.
SurfaceTolerance default_tolerance(const Plc& plc, double size, int order = 1);

/// The largest of them by place, of all sizes and orders.
SurfaceTolerance largest_default_tolerance(const Plc& plc);

/// The smooth patches whose triangles are farther from the surfaces that they stand for than a quarter of the
/// tolerance, as far as the angles between them tell. Cost: near linear in the triangles.
std::vector<Index> coarse_patches(const Plc& plc, const SurfaceTolerance& tolerance);

}  // namespace collarmesh
