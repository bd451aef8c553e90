#pragma once

#include <cstddef>
#include <vector>

#include "partition/scotch_module.h"

namespace collarmesh {

/// Move single tets until no partition is empty and none has more than `most`: along the shortest way from
/// one that has too many to one that has room, over the tets that cut the fewest faces there. Preconditions:
/// as many tets as partitions at least, and room for all, `most` times these. Cost: of each tet too many, a
/// search over the tets of the partitions on the way; at worst over all tets.
void level_partitions(const DualGraph& graph, std::size_t partitions, std::size_t most,
                      std::vector<GraphIndex>& partition_of);

}  // namespace collarmesh
