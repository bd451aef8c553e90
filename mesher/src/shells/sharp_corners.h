#pragma once

#include <array>
#include <vector>

#include "shells/chord_limits.h"
#include "shells/surface_complex.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// Corners of patches, between two curves, that are too sharp for two good triangles. At such a corner the
/// first edges of the curves, the tips, are equally long. A triangle between two tips closes the corner, and
/// no sharp corner remains behind it.
class SharpCorners {
 public:
  /// Finds the corners. Precondition: `complex` has triangles on the patches of `plc`. Cost: linear.
  SharpCorners(const SurfaceComplex& complex, const Plc& plc, const CurvePaths& paths,
               const SurfaceSizes& sizes, const ChordLimits& limits);

  /// Returns the lengths of the first and of the last edge of a curve; 0 for an end that is not at a sharp
  /// corner.
  const std::array<double, 2>& tips(Index curve) const { return tips_[curve]; }
  /// Sets `Edge::tip` of the tips, and lowers the sizes at their ends to the tips' lengths.
  void mark(SurfaceComplex& complex) const;

 private:
  struct End {
    Index curve;
    unsigned end;  // 0: the beginning of the curve, 1: its end
  };
  struct Corner {
    Index vertex;                // the vertex of the input
    std::vector<End> ends;       // the ends of curves that form its sharp angles
    std::vector<Index> patches;  // the patches with these angles
  };
  Corner find(const SurfaceComplex& complex, Index vertex) const;
  double tip_length(const Plc& plc, const CurvePaths& paths, const SurfaceSizes& sizes,
                    const ChordLimits& limits, const Corner& corner) const;

  std::vector<std::array<double, 2>> tips_;
};

}  // namespace collarmesh::shells
