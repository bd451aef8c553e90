#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "refine/frame.h"
#include "tolerance/curvature.h"

namespace collarmesh {

/// A conversion of the requested sizes to target edge lengths, and of these to bounds on circumradii. The
/// factors are measured (doc/architecture/refinement.md).
///
/// Callers are CurveChains::too_coarse, TriangleQuality::target_size and CellQuality::judge, to decide about
/// splits; GradedSizes::cells_made, for the size at a new vertex; CollarCreator::target_size, for the radii
/// of balls; coarsen/target_sizes.cpp, adapt/edge_division.cpp, shells/surface_sizes.* and
/// predict/vertex_counts.cpp, for the same sizes in other stages. A new kind of size must be added to each of
/// them (doc/contributing.md); if it calls the user's code or is kept at vertices, BlockRefinement must not
/// run rounds with it, as with `has_field`.
class Sizing {
 public:
  /// Target edge length per unit of a size given as a length; in meshes of other meshers the median edge is
  /// even longer than that. Sizes given as numbers of elements, across a gap or on a circle, are used as they
  /// are.
  static constexpr double edge_per_size = 1.08;
  /// If the mesh will be coarsened, cells may exceed the radius-edge bound in gaps narrower than this share
  /// of the target edge length: in wider gaps the bound costs little, and improves angles.
  static constexpr double narrow_gap_per_size = 0.1;

  /// Makes the sizes. Functions that take a place throw OptionError if the field returns no positive size
  /// there; an infinite size sets no bound.
  Sizing(const Plc& plc, const MeshOptions& options, const Frame& frame);

  /// Returns the largest allowed circumradius of a cell of this region at this point; infinite outside.
  /// `graded` is the target edge length that gradation imposes.
  double cell_radius(Index region, const Point& p, double graded) const {
    return region == 0 ? INFINITY : cell_radius_per_edge * std::min(graded, limited(region_size_[region], p));
  }
  /// Returns the target edge length on a patch at a point of a triangle of the complex.
  double triangle_size(Index patch, Index triangle, const Point& p) const {
    const double size = limited(patch_size_[patch], p);
    return curved_.triangle.empty() ? size : std::min(size, at_least_minimum(curved_.triangle[triangle]));
  }
  /// Returns the largest allowed radius of a surface gap ball for this target edge length.
  static double triangle_radius(double size) { return triangle_radius_per_edge * size; }
  /// Returns the target edge length for a piece of a curve, from segment `first` to segment `last` of the
  /// curve's polyline, at a point of the piece.
  double curve_size(Index curve, std::size_t first, std::size_t last, const Point& p) const;
  /// Returns the largest allowed length of a subsegment for this target edge length.
  static double subsegment_length(double size) { return subsegment_length_per_edge * size; }
  /// Returns the target edge length between two facing parts of the surface at this distance; infinite unless
  /// the options ask for elements across gaps.
  double gap_size(double gap) const {
    return elements_across_gap_ > 0 ? at_least_minimum(gap / elements_across_gap_) : INFINITY;
  }
  /// Returns the width below which gaps make elements finer than `size`; 0: no gap does.
  double widest_gap(double size) const { return elements_across_gap_ * size; }
  /// Returns the target edge length at a mesh vertex on this feature (`dimension` 1: curve, 2: patch).
  double feature_size(unsigned dimension, Index feature, const Point& p) const {
    return limited(dimension == 1 ? curve_size_[feature] : patch_size_[feature], p);
  }
  /// Returns the target edge length inside a region; infinite outside.
  double region_size(Index region, const Point& p) const {
    return region == 0 ? INFINITY : limited(region_size_[region], p);
  }
  /// Returns the target edge length where nothing finer applies.
  double default_size(const Point& p) const { return limited(global_size_, p); }
  /// Returns whether the caller provides a size field.
  bool has_field() const { return static_cast<bool>(field_); }
  /// Returns the approximate number of cells of the whole domain.
  double expected_cells() const { return expected_cells_; }

 private:
  static constexpr double cell_radius_per_edge = 0.79;
  static constexpr double triangle_radius_per_edge = 0.7;
  static constexpr double subsegment_length_per_edge = 1.3;

  double limited(double size, const Point& p) const {
    if (!field_) return size;
    const Point place = frame_.outside(p);
    const double asked = field_(place);
    if (!(asked > 0)) refuse(asked, place);
    return std::min(size, edge_per_size * std::max(asked, size_min_));
  }
  /// Throws OptionError about an invalid size at a place.
  [[noreturn]] static void refuse(double asked, const Point& place);

  double at_least_minimum(double size) const { return std::max(size, size_min_); }

  CurvatureSizes curved_;  // empty unless the options ask for sizes by curvature
  double elements_across_gap_;
  std::vector<double> region_size_, patch_size_, curve_size_;  // target edge lengths by index
  std::function<double(const Point&)> field_;
  Frame frame_;
  double size_min_ = 0, expected_cells_ = 1, global_size_ = INFINITY;
};

}  // namespace collarmesh
