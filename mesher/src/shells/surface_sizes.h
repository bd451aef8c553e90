#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "location/curve_paths.h"
#include "refine/sizing.h"
#include "shells/surface_complex.h"

namespace collarmesh::shells {

/// Target edge lengths on curves and patches. They grow by at most the gradation per unit length away from
/// where they are small, and from curves that are shorter.
class SurfaceSizes {
 public:
  /// Keeps all by reference.
  SurfaceSizes(const Plc& plc, const CurvePaths& paths, const MeshOptions& options);

  double gradation() const { return gradation_; }
  /// What is asked for at a place of a patch, on a triangle of the complex.
  double on_patch(Index patch, Index triangle, const Point& p) const {
    return sizing_.triangle_size(patch, triangle, p);
  }
  /// What is asked for on a curve, and what the lengths of curves at its ends permit.
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

/// Makes the sizes at vertices keep the gradation along edges. Cost: n log n.
void grade(SurfaceComplex& complex, double gradation);

}  // namespace collarmesh::shells
