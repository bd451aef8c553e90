#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "plc/features.h"

namespace collarmesh::plc {

/// Joins segments to curves and finds the vertices at which they end. Fills plc.vertices and plc.curves
/// except Vertex::patches; `patch_of` gives the patch of each triangle. A curve continues through a point if
/// exactly two segments meet there, which bound the same patches, have the same tag, and (unless both are
/// given) turn by at most the feature angle (degrees; 0: only within the planar tolerance of a straight
/// line), and if the surface there is one fan of triangles. The points in `folds` are vertices, too.
void find_curves(facets::ComplexDraft& draft, const facets::EdgeTable& edges,
                 const std::vector<FeatureSegment>& segments, const std::vector<Index>& patch_of,
                 const std::vector<Index>& folds, double feature_angle, Plc& plc);

}  // namespace collarmesh::plc
