#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/flat_clusters.h"

namespace collarmesh::plc {

/// A straight piece of a future curve.
struct FeatureSegment {
  Index a = 0, b = 0;
  Index edge = none;  ///< index in the edge table; none if no triangle has it
  Tag tag = 0;
  bool given = false;  ///< from a soup that gives its features: turns do not end its curve
};

/// Finds the segments: edges that the input gives as segments; edges that are not shared by exactly two
/// triangles; edges between different tags or soups; and edges between flat clusters where a surface turns by
/// more than the feature angle (degrees; 0: at all) or, if its features are given, by more than 90 degrees.
std::vector<FeatureSegment> find_segments(const facets::ComplexDraft& draft, const facets::EdgeTable& edges,
                                          const facets::FlatClusters& clusters, double feature_angle);

/// Finds the patch of each triangle: a patch is connected across edges that are not segments. Patches are
/// numbered by their first triangle. Returns the number of patches.
Index find_patches(const facets::ComplexDraft& draft, const facets::EdgeTable& edges,
                   const std::vector<FeatureSegment>& segments, std::vector<Index>& patch_of);

/// Fits a plane to the points of the patch. If all are within the planar tolerance of the plane, sets planar,
/// normal and origin, and raises the draft's largest deviation to that of the points, if that is larger.
void fit_plane(facets::ComplexDraft& draft, const std::vector<Index>& triangles, Plc::Patch& patch);

}  // namespace collarmesh::plc
