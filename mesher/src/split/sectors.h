#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::splitting {

/// Sorted corners of a triangle.
using Key = std::array<Index, 3>;

/// A node of a tet: its corner (places 0 to 3) or mid-edge node (4 to 9).
struct NodeOfTet {
  Index node, tet;
  std::uint8_t place;
};

/// Divides the tets at each node into sectors: tets that share a side at the node are in one sector unless
/// the side is split. For each sector but the first, in the order of regions and tets, calls `copy(node,
/// members)`. If the tets at a node form groups without common sides even before the split, the first sector
/// of each group keeps the node. Cost: n log n.
void for_each_further_sector(const TetMesh& mesh, std::vector<NodeOfTet> nodes,
                             const std::function<bool(const Key&)>& is_split,
                             const std::function<void(Index, const std::vector<NodeOfTet>&)>& copy);

}  // namespace collarmesh::splitting
