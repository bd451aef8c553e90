#pragma once

#include <memory>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh::remeshing::adapting {

/// Returns smooth geometry through the points of a complex whose facets are the faces of a coarse mesh.
///
/// Displaces each triangle of a smooth patch along the interpolated normals of its corners by a cubic height,
/// such that the surface is perpendicular to the normal at each corner and continuous over the patch. The
/// heights are those of PN triangles (Vlachos, Peters, Boyd, Mitchell, Curved PN triangles, 2001). Normals
/// are weighted so that they are exact on spheres (Max, Weights for computing vertex normals from facet
/// normals, 1999). Displaces the segments of a curve by cubics, too, such that the curve is tangent at each
/// point to the circle through this point and its two neighbours. Where triangles of a patch, or segments of
/// a curve, meet at a point at too sharp an angle to be smooth, they run straight into the point. No point
/// moves farther from the facets than a share of the tolerance. Planar patches and straight curves stay as
/// they are. Keeps the complex by reference. Cost: O(n log n).
ExactGeometry smooth_geometry(const Plc& plc, const SurfaceTolerance& tolerance);

}  // namespace collarmesh::remeshing::adapting
