#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// The largest distance that a mesh may have from the smooth patches and curves of a complex; it may depend
/// on the place. Lengths are absolute. Copies share their data.
class SurfaceTolerance {
 public:
  /// Makes a tolerance that is the same everywhere.
  explicit SurfaceTolerance(double distance) : largest_(distance) {}
  /// Makes a tolerance from one value for each triangle of the complex. Precondition: none exceeds `largest`.
  SurfaceTolerance(const Plc& plc, std::vector<double> triangles, double largest);

  /// Returns whether the tolerance depends on the place.
  bool varies() const { return places_ != nullptr; }
  double largest() const { return share_ * largest_; }
  double at_triangle(Index triangle) const {
    return share_ * (varies() ? places_->triangles[triangle] : largest_);
  }
  /// Returns the tolerance at a point of the complex: the smallest one of the triangles there.
  double at_point(Index point) const { return share_ * (varies() ? places_->points[point] : largest_); }
  /// Returns the tolerance of the segment between two neighbouring points of a curve.
  double at_segment(Index a, Index b) const { return std::min(at_point(a), at_point(b)); }
  /// Return the smallest tolerance at points of a patch, and the largest one of its triangles.
  double least_on_patch(Index patch) const {
    return share_ * (varies() ? places_->least_on_patch[patch] : largest_);
  }
  double largest_on_patch(Index patch) const {
    return share_ * (varies() ? places_->largest_on_patch[patch] : largest_);
  }
  /// Return the smallest and the largest tolerance on a curve's segments.
  double least_on_curve(const Plc::Curve& curve) const;
  double largest_on_curve(const Plc::Curve& curve) const;
  /// Returns this tolerance times a factor.
  SurfaceTolerance scaled(double share) const {
    SurfaceTolerance scaled = *this;
    scaled.share_ *= share;
    return scaled;
  }
  /// Returns this tolerance for a complex that has some of the patches of `whole`, in this order, and all its
  /// points.
  SurfaceTolerance of_patches(const Plc& whole, std::span<const Index> patches) const;

 private:
  struct Places {
    std::vector<double> triangles, points, least_on_patch, largest_on_patch;
  };

  std::shared_ptr<const Places> places_;
  double largest_, share_ = 1;
};

/// Returns the tolerance of a run without a given distance: a tenth of the target edge length (`size`; 0: the
/// default length), at most 1/200 of the diagonal, at most a share of the thickness of the material on either
/// side, so that its volume is kept, and at most a share of the width of gaps and holes. Opposite sides of a
/// wall that bend the same way lose and gain the same volume, so their tolerance is larger than that of a
/// rod, whose sides all lose volume. With elements of second order the tolerance of the triangles between
/// corners is larger, because the curved elements follow the surface. Cost: near linear in the triangles.
SurfaceTolerance default_tolerance(const Plc& plc, double size, int order = 1);

/// Returns, for each place, the largest default tolerance there over all sizes and orders.
SurfaceTolerance largest_default_tolerance(const Plc& plc);

/// A patch whose triangles are too coarse.
struct CoarsePatch {
  Index patch;
  double
      by;  ///< largest distance of its triangles from its surface, relative to the distance allowed: above 1
};

/// Returns the smooth patches whose triangles are farther than a quarter of the tolerance from the surface
/// that they approximate. Estimates this distance from the angles between the triangles. Cost: near linear in
/// the triangles.
std::vector<CoarsePatch> coarse_patches(const Plc& plc, const SurfaceTolerance& tolerance);

}  // namespace collarmesh
