#pragma once

#include <vector>

#include "facets/draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// Groups of connected triangles whose corners lie in one plane: within the planar tolerance of
/// that of their largest triangle, exactly if the tolerance is 0. They give needles, whose own
/// normals are rounding noise, a normal to judge by.
struct FlatClusters {
  std::vector<Index> seed;     ///< by triangle: the largest of its cluster
  std::vector<Vector> normal;  ///< by triangle, unit; of itself, or of its seed if it is a needle
};

/// Where a cluster ends besides.
enum class ClusterBorder {
  none,           ///< only where it leaves its plane
  given_features  ///< between facets of different tags in soups that give their features
};

/// Cost: O(n log n).
FlatClusters find_flat_clusters(const Draft& draft, const EdgeTable& edges,
                                ClusterBorder border = ClusterBorder::none);

/// Unit normal of a triangle of the draft.
Vector unit_normal(const Draft& draft, Index triangle);

}  // namespace collarmesh::facets
