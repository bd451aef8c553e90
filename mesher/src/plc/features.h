#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "facets/draft.h"
#include "facets/edges.h"
#include "facets/flat_clusters.h"

namespace collarmesh::plc {

/// A straight piece of the curves to be.
struct FeatureSegment {
  Index a = 0, b = 0;
  Index edge = none;  ///< in the edge table, none if no triangle has it
  Tag tag = 0;
  bool given = false;  ///< of a soup that gives its features: no angle ends its curve
};

/// The segments: edges that the input names, that are not shared by exactly two triangles, between
/// different tags or soups, or where a surface that does not give its features turns by more than the
/// feature angle (degrees).
std::vector<FeatureSegment> find_segments(const facets::Draft& draft, const facets::EdgeTable& edges,
                                          const facets::FlatClusters& clusters, double feature_angle);

/// For each triangle its patch: connected across the edges that are no segments. Numbered by first
/// triangle. Returns the number of patches.
Index find_patches(const facets::Draft& draft, const facets::EdgeTable& edges,
                   const std::vector<FeatureSegment>& segments, std::vector<Index>& patch_of);

/// A plane that all points of the patch lie in within the tolerance: then sets planar, normal,
/// origin. Raises the draft's deviation.
void fit_plane(facets::Draft& draft, const std::vector<Index>& triangles, Plc::Patch& patch);

}  // namespace collarmesh::plc
