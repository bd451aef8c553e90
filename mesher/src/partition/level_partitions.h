#pragma once

#include <cstddef>
#include <vector>

#include "partition/scotch_module.h"

namespace collarmesh {

/// Moves single tets until no partition is empty and none has more than `most`: along the shortest path from
/// a partition with too many tets to one with fewer than `most`, choosing tets whose move cuts the fewest
/// faces. Preconditions: there are at least as many tets as partitions, and at most `most` times
/// `partitions`. Cost: for each surplus tet a search over the tets of the partitions on the path; at worst
/// over all tets.
void level_partitions(const DualGraph& graph, std::size_t partitions, std::size_t most,
                      std::vector<GraphIndex>& partition_of);

}  // namespace collarmesh
