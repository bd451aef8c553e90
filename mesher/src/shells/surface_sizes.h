#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "location/curve_paths.h"
#include "refine/sizing.h"
#include "shells/surface_complex.h"

namespace collarmesh::shells {

/// Target edge lengths on curves and patches. They grow by at most the gradation per unit of distance, away
/// from places with small target lengths and from curves that are shorter than their target length.
class SurfaceSizes {
 public:
  /// Keeps references to all arguments.
  SurfaceSizes(const Plc& plc, const CurvePaths& paths, const MeshOptions& options);

  double gradation() const { return gradation_; }
  /// Returns the target edge length at a place of a patch, on a triangle of the complex.
  double on_patch(Index patch, Index triangle, const Point& p) const {
    return sizing_.triangle_size(patch, triangle, p);
  }
  /// Returns the target edge length on a curve, considering the lengths of the curves at its ends.
  /// `parameter`: the arc length.
  double on_curve(Index curve, double parameter) const;
  double at_vertex(Index vertex) const { return at_vertex_[vertex]; }
  /// Returns the edge length that the options ask for on a curve, without regard to the lengths of curves.
  double asked_on_curve(Index curve, double parameter) const;
  double asked_at_vertex(Index vertex) const;
  /// Returns whether the options give a gradation. If not, angles alone limit how fast edge lengths grow away
  /// from short curves and narrow places.
  bool gradation_is_given() const { return gradation_is_given_; }

 private:
  const Plc& plc_;
  const CurvePaths& paths_;
  Sizing sizing_;
  double gradation_;
  bool gradation_is_given_;
  std::vector<double> at_vertex_;
};

/// Reduces sizes at vertices (`size` or `asked`) until they keep the gradation along all edges. Cost: n log
/// n.
void grade(SurfaceComplex& complex, double gradation,
           double SurfaceComplex::Vertex::*sizes = &SurfaceComplex::Vertex::size);

}  // namespace collarmesh::shells
