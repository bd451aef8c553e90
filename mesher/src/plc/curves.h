#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "plc/features.h"

namespace collarmesh::plc {

/// Joins segments to curves, which end at vertices. Fills plc.vertices (except Vertex::patches) and
/// plc.curves; `patch_of` gives the patch of each triangle. A curve continues through a point if exactly two
/// segments meet there, with the same patches and the same tag, and the triangles at the point form one fan.
/// The curve must not turn there by more than the feature angle (degrees; 0: the curve must stay within the
/// planar tolerance of a straight line), unless both segments are given. Points that the input gives as
/// vertices, and the points in `folds`, are always vertices.
void find_curves(facets::ComplexDraft& draft, const facets::EdgeTable& edges,
                 const std::vector<FeatureSegment>& segments, const std::vector<Index>& patch_of,
                 const std::vector<Index>& folds, double feature_angle, Plc& plc);

}  // namespace collarmesh::plc
