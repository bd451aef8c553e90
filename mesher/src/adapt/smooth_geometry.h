#pragma once

#include <memory>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh::remeshing::adapting {

/// Returns smooth geometry through the points of a complex whose facets are the faces of a coarse mesh.
///
/// Over each triangle of a smooth patch, the surface is a cubic height along the interpolated normals of its
/// corners: at a corner it is tangent to the plane of the corner's normal (the heights are those of PN
/// triangles: Vlachos, Peters, Boyd, Mitchell, Curved PN triangles, 2001). It is continuous over a patch.
/// Normals are those that are exact on spheres (Max, Weights for computing vertex normals from facet normals,
/// 1999). Curves are cubic offsets that are tangent to the circles through three points. The surface stays
/// straight towards points where triangles of a patch, or segments of a curve, turn too far to be smooth. It
/// is nowhere farther from the facets than a share of the tolerance. Planar
/// patches and straight curves are exact. Keeps the complex by reference. Cost: O(n log n).
ExactGeometry smooth_geometry(const Plc& plc, const SurfaceTolerance& tolerance);

}  // namespace collarmesh::remeshing::adapting
