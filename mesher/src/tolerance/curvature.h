#pragma once

#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// The curvature of a smooth patch at a triangle, in inverse input units.
struct Curvature {
  double largest = 0;  ///< the larger of the principal curvatures' absolute values
  double sum = 0;      ///< sum of both principal curvatures: positive if the surface bends away from the side
                       ///< that its normals point to
};

/// Returns the curvatures of a patch at each of its triangles, from the curvature tensor of its tessellation
/// averaged over the triangles around each point (Cohen-Steiner and Morvan: Restricted Delaunay
/// triangulations and normal cycle, 2003). Cost: linear.
std::vector<Curvature> curvatures(const Plc& plc, const Plc::Patch& patch);

/// Target edge lengths, absolute, with which N elements make a full circle of the local curvature.
struct CurvatureSizes {
  std::vector<double> triangle;  ///< size at every triangle of the complex; infinite where flat
  std::vector<std::vector<double>> curve_segment;  ///< by curve: size at every segment; empty if straight
};

/// Returns the sizes. For a triangle of a smooth patch, the larger principal curvature counts. For a segment
/// of a curve, the larger of the curvatures at its two ends counts. The curvature at a point of the curve is
/// the angle by which the polyline turns there, divided by the mean length of its two segments. Cost: linear.
CurvatureSizes curvature_sizes(const Plc& plc, double elements_per_circle);

}  // namespace collarmesh
