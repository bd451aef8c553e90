#pragma once

#include <cstddef>

namespace collarmesh {

/// What was done so that no tet has all corners on boundaries, interfaces or patches inside regions
/// (Bounds::interior_node), before and after the mesh was coarsened.
struct InteriorNodesReport {
  std::size_t found = 0;           ///< tets without a corner inside a region
  std::size_t inserted_nodes = 0;  ///< inside regions; coarsening removes those that are not needed
  std::size_t removed_edges = 0;   ///< in place of which others have such tets go
  std::size_t remaining = 0;       ///< of the finished mesh
};

}  // namespace collarmesh
