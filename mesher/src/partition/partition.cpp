#include "collarmesh/partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "common/layer_tets.h"
#include "common/module_function.h"
#include "partition/level_partitions.h"
#include "partition/scotch_module.h"
#include "partition/shared_faces.h"

namespace collarmesh {

namespace {

constexpr double imbalance = 0.03;

/// Loads Scotch from a module when it is used, because programs that do not partition need none of its
/// libraries.
ScotchPartition find_scotch() {
#ifdef COLLARMESH_HAS_SCOTCH
  std::string reason;
  void* const found = module_function("collarmesh_scotch.so", "collarmesh_scotch_partition", reason);
  if (found == nullptr) throw OptionError("partitions cannot be made, because " + reason);
  return reinterpret_cast<ScotchPartition>(found);
#else
  throw OptionError(
      "partitions cannot be made, because the program was built without Scotch; install libscotch-dev and "
      "build the program again");
#endif
}

DualGraph dual_graph(const TetMesh& mesh) {
  constexpr std::size_t limit = std::numeric_limits<GraphIndex>::max() / 4;
  if (mesh.tets.size() > limit)
    throw OptionError(
        fmt::format("a mesh of {} tets cannot be divided into partitions; it may have at most {}",
                    mesh.tets.size(), limit));
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(2 * mesh.tets.size());
  DualGraph graph;
  graph.starts.resize(mesh.tets.size() + 1, 0);
  for_each_shared_face(mesh, [&](Index t, Index u) {
    edges.emplace_back(t, u);
    ++graph.starts[std::size_t{t} + 1];
    ++graph.starts[std::size_t{u} + 1];
  });
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) graph.starts[t + 1] += graph.starts[t];
  graph.neighbours.resize(2 * edges.size());
  std::vector<GraphIndex> next(graph.starts.begin(), graph.starts.end() - 1);
  const auto add = [&](Index t, Index u) {
    graph.neighbours[static_cast<std::size_t>(next[t]++)] = static_cast<GraphIndex>(u);
  };
  for (const auto& [t, u] : edges) {
    add(t, u);
    add(u, t);
  }
  return graph;
}

std::size_t cut_of(const DualGraph& graph, const std::vector<GraphIndex>& partition_of) {
  std::size_t cut = 0;
  for (std::size_t t = 0; t < partition_of.size(); ++t)
    for (GraphIndex k = graph.starts[t]; k < graph.starts[t + 1]; ++k) {
      const auto neighbour = static_cast<std::size_t>(graph.neighbours[static_cast<std::size_t>(k)]);
      cut += partition_of[t] != partition_of[neighbour] ? 1 : 0;
    }
  return cut / 2;
}

/// Returns the partition with the fewest cut faces. Tries several seeds for small meshes, where luck matters
/// most and time least; a single seed for others.
std::vector<GraphIndex> best_by_scotch(ScotchPartition by_scotch, const DualGraph& graph,
                                       unsigned partitions) {
  constexpr std::size_t small = 50'000;
  const std::size_t tets = graph.starts.size() - 1;
  std::vector<GraphIndex> best, partition_of(tets);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (int seed = 1; seed <= (tets < small ? 4 : 1); ++seed) {
    if (!by_scotch(graph, partitions, imbalance, seed, partition_of.data()))
      throw OptionError(
          fmt::format("Scotch cannot make {} partitions of {} tets; ask for fewer, or allow more memory",
                      partitions, tets));
    if (const std::size_t cut = cut_of(graph, partition_of); cut < least) {
      least = cut;
      best = partition_of;
    }
  }
  return best;
}

}  // namespace

void require_partitioner() { find_scotch(); }

void partition(TetMesh& mesh, unsigned partitions) {
  require_tets_alone(mesh, "partitions");
  const std::size_t tets = mesh.tets.size();
  if (partitions < 1 || partitions > tets)
    throw OptionError(
        fmt::format("partitions is {}, but the mesh has {} tets; ask for 1 to {} partitions, or for a finer "
                    "mesh",
                    partitions, tets, tets));
  const ScotchPartition by_scotch = find_scotch();
  std::vector<GraphIndex> partition_of(tets, 0);
  if (partitions > 1) {
    const DualGraph graph = dual_graph(mesh);
    partition_of = best_by_scotch(by_scotch, graph, partitions);
    const std::size_t mean = (tets + partitions - 1) / partitions;
    const auto tolerated = static_cast<std::size_t>((1 + imbalance) * static_cast<double>(tets) / partitions);
    level_partitions(graph, partitions, std::max(mean, tolerated), partition_of);
  }
  mesh.tet_partition.assign(partition_of.begin(), partition_of.end());
}

}  // namespace collarmesh
