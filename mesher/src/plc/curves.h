#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "facets/draft.h"
#include "facets/edges.h"
#include "plc/features.h"

namespace collarmesh::plc {

/// Chains the segments to curves and finds the vertices that end them. Fills plc.vertices and plc.curves
/// except Vertex::patches; `patch_of` gives the patch of each triangle. A curve passes a point where exactly
/// two segments meet that bound the same patches, have the same tag, turn by less than the feature angle
/// (degrees; 0: only within the planar tolerance of a straight line), and where the surface is one fan of
/// triangles. The points in `folds` are vertices, too.
void find_curves(facets::Draft& draft, const facets::EdgeTable& edges,
                 const std::vector<FeatureSegment>& segments, const std::vector<Index>& patch_of,
                 const std::vector<Index>& folds, double feature_angle, Plc& plc);

}  // namespace collarmesh::plc
