#pragma once

#include <cstddef>

namespace collarmesh {

/// Counts of the changes, before and after coarsening, that give every tet a corner inside a region
/// (Bounds::interior_node): one that is on no boundary, interface or patch.
struct InteriorNodesReport {
  std::size_t found = 0;           ///< tets without a corner inside a region, before the changes
  std::size_t inserted_nodes = 0;  ///< nodes inserted inside regions; coarsening removes those that are not
                                   ///< needed
  std::size_t removed_edges = 0;   ///< edges removed so that tets with such a corner replace tets without one
  std::size_t remaining = 0;       ///< tets without a corner inside a region in the finished mesh
};

}  // namespace collarmesh
