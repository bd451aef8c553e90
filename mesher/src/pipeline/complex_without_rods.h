#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "constrained/sheathed_rods.h"

namespace collarmesh::pipeline {

/// A complex in which the regions around rods extend into the rods, with vertices along the axes of the rods.
/// Features are numbered anew.
struct ComplexWithoutRods {
  Plc plc;
  /// By feature of this complex: the same feature of the whole complex; none for the vertices on axes.
  std::vector<Index> vertex_of, curve_of, patch_of, region_of;
  std::vector<Index> triangle_of;  ///< by triangle of this complex: the same triangle of the whole complex

  /// Returns the tolerance of this complex that corresponds to one of the whole complex.
  SurfaceTolerance tolerance_from(const SurfaceTolerance& whole) const;
};

/// Returns the complex without these rods; nothing if a vertex on the curve around a rod's end lies also on a
/// curve that stays.
std::optional<ComplexWithoutRods> complex_without_rods(const Plc& whole,
                                                       const std::vector<SheathedRod>& rods);

}  // namespace collarmesh::pipeline
