#pragma once

#include <cstddef>

namespace collarmesh {

/// The changes made so that no tet has all corners on boundaries, interfaces or patches inside regions
/// (Bounds::interior_node), before and after the mesh was coarsened.
struct InteriorNodesReport {
  std::size_t found = 0;           ///< tets without a corner inside a region, before
  std::size_t inserted_nodes = 0;  ///< nodes inside regions; coarsening removes those that are not needed
  std::size_t removed_edges = 0;   ///< edges removed so that such tets became others
  std::size_t remaining = 0;       ///< tets without a corner inside a region in the finished mesh
};

}  // namespace collarmesh
