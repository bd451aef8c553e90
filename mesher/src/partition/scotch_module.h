#pragma once

#include <cstdint>
#include <vector>

/// The functions that `partition` calls in the module with Scotch.
namespace collarmesh {

using GraphIndex = std::int32_t;  // Scotch's own integer, in Debian's library

/// The graph of tets that share a face: the neighbours of t are neighbours[starts[t]] to neighbours[starts[t
/// + 1]]; each pair is listed at both tets.
struct DualGraph {
  std::vector<GraphIndex> starts, neighbours;
};

/// Gives each tet a partition; returns false where Scotch fails.
using ScotchPartition = bool (*)(const DualGraph& graph, unsigned partitions, double imbalance, int seed,
                                 GraphIndex* partition_of);

}  // namespace collarmesh
