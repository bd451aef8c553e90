#pragma once

#include <cstdint>
#include <vector>

/// The interface of the module with Scotch, which `partition` loads.
namespace collarmesh {

using GraphIndex = std::int32_t;  // Scotch's integer type, as in Debian's library

/// The graph of tets that share a face. The neighbours of t begin at neighbours[starts[t]] and end before
/// neighbours[starts[t + 1]]; each pair is listed at both tets.
struct DualGraph {
  std::vector<GraphIndex> starts, neighbours;
};

/// Assigns each tet to a partition. Returns false if Scotch fails.
using ScotchPartition = bool (*)(const DualGraph& graph, unsigned partitions, double imbalance, int seed,
                                 GraphIndex* partition_of);

}  // namespace collarmesh
