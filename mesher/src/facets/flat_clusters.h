#pragma once

#include <vector>

#include "facets/complex_draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// Groups of connected triangles whose corners lie in one plane: within the planar tolerance of the plane of
/// their largest triangle, or exactly if the tolerance is 0. Needles, whose own normals are rounding noise,
/// get the normal of their group.
struct FlatClusters {
  std::vector<Index> seed;     ///< by triangle: the largest triangle of its cluster
  std::vector<Vector> normal;  ///< by triangle: its unit normal; for needles, that of the seed
};

/// Edges at which clusters end even if the triangles on both sides lie in one plane.
enum class ClusterBorder {
  none,           ///< no such edges
  given_features  ///< between facets of different tags or soups, if one of these soups gives its features
};

/// Finds the clusters. Cost: O(n log n).
FlatClusters find_flat_clusters(const ComplexDraft& draft, const EdgeTable& edges,
                                ClusterBorder border = ClusterBorder::none);

/// Returns the unit normal of a triangle of the draft; zero if it has no area.
Vector unit_normal(const ComplexDraft& draft, Index triangle);

}  // namespace collarmesh::facets
