#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "location/curve_paths.h"
#include "refine/sizing.h"
#include "shells/surface_complex.h"

namespace collarmesh::shells {

/// Target edge lengths on curves and patches. They grow by at most the gradation per unit length with the
/// distance from small ones, and from curves that are shorter than them.
class SurfaceSizes {
 public:
  /// Keeps all by reference.
  SurfaceSizes(const Plc& plc, const CurvePaths& paths, const MeshOptions& options);

  double gradation() const { return gradation_; }
  /// Returns the target edge length at a place of a patch, on a triangle of the complex.
  double on_patch(Index patch, Index triangle, const Point& p) const {
    return sizing_.triangle_size(patch, triangle, p);
  }
  /// Returns the target edge length on a curve, considering the lengths of the curves at its ends.
  double on_curve(Index curve, double parameter) const;
  double at_vertex(Index vertex) const { return at_vertex_[vertex]; }

 private:
  double asked_on_curve(Index curve, double parameter) const;

  const Plc& plc_;
  const CurvePaths& paths_;
  Sizing sizing_;
  double gradation_;
  std::vector<double> at_vertex_;
};

/// Reduces the sizes at vertices until they keep the gradation along all edges. Cost: n log n.
void grade(SurfaceComplex& complex, double gradation);

}  // namespace collarmesh::shells
