#pragma once

#include <cstddef>

namespace collarmesh {

/// Counts of the changes that leave no tet with all corners on boundaries, interfaces or patches inside
/// regions (Bounds::interior_node), made before and after coarsening.
struct InteriorNodesReport {
  std::size_t found = 0;           ///< tets without a corner inside a region, before the changes
  std::size_t inserted_nodes = 0;  ///< nodes inserted inside regions; coarsening removes those that are not
                                   ///< needed
  std::size_t removed_edges = 0;   ///< edges removed so that other tets replace such tets
  std::size_t remaining = 0;       ///< tets without a corner inside a region in the finished mesh
};

}  // namespace collarmesh
