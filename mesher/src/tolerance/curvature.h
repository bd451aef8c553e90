#pragma once

#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// The curvature of a smooth patch at a triangle, per length unit.
struct Curvature {
  double largest = 0;  ///< the larger of the principal curvatures' absolute values
  double sum = 0;      ///< sum of both: positive where the surface bends away from the side that its normals
                       ///< point to
};

/// Returns the curvatures of a patch by its triangles: those of the curvature tensor of its tessellation,
/// averaged over the triangles around a point (Cohen-Steiner and Morvan: Restricted Delaunay triangulations
/// and normal cycle, 2003). Cost: linear.
std::vector<Curvature> curvatures(const Plc& plc, const Plc::Patch& patch);

/// Target edge lengths, absolute, that put N elements on a full circle of the curvature.
struct CurvatureSizes {
  std::vector<double> triangle;                    ///< of every triangle of the complex; infinite where flat
  std::vector<std::vector<double>> curve_segment;  ///< of every segment of every curve's polyline
};

/// Returns the sizes. The curvature of a smooth patch is the larger principal one; that of a curve is the
/// turning angle of its polyline by its length. Cost: linear.
CurvatureSizes curvature_sizes(const Plc& plc, double elements_per_circle);

}  // namespace collarmesh
