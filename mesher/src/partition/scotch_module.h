#pragma once

#include <cstdint>
#include <vector>

/// The functions that `partition` calls in the module with Scotch.
namespace collarmesh {

using GraphIndex = std::int32_t;  // Scotch's own, in Debian's library

/// The tets, and which of them share a face: those beside t are neighbours[starts[t]] to
/// neighbours[starts[t + 1]], each of an edge's ends with the other.
struct DualGraph {
  std::vector<GraphIndex> starts, neighbours;
};

/// Gives each tet a partition; false where Scotch fails.
using ScotchPartition = bool (*)(const DualGraph& graph, unsigned partitions, double imbalance, int seed,
                                 GraphIndex* partition_of);

}  // namespace collarmesh
