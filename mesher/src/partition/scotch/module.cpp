// Calls Scotch (www.labri.fr/perso/pelegrin/scotch) for ../partition.cpp.

#include <scotch.h>

#include "scotch_module.h"

namespace {

static_assert(sizeof(SCOTCH_Num) == sizeof(collarmesh::GraphIndex));

/// Scotch's structures; the destructor frees those that were initialized.
struct Work {
  SCOTCH_Context context;
  SCOTCH_Graph graph, bound;
  SCOTCH_Strat strategy;

  Work() {
    SCOTCH_contextInit(&context);
    SCOTCH_graphInit(&graph);
    SCOTCH_graphInit(&bound);
    SCOTCH_stratInit(&strategy);
  }
  ~Work() {
    SCOTCH_stratExit(&strategy);
    SCOTCH_graphExit(&bound);
    SCOTCH_graphExit(&graph);
    SCOTCH_contextExit(&context);
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Sets up one thread with its own random numbers from this seed, so that the result is the same
  /// everywhere. By default all contexts share one sequence.
  bool make_repeatable(int seed) {
    if (SCOTCH_contextRandomClone(&context) != 0) return false;
    SCOTCH_contextRandomSeed(&context, seed);
    SCOTCH_contextRandomReset(&context);
    return SCOTCH_contextOptionSetNum(&context, SCOTCH_OPTIONNUMDETERMINISTIC, 1) == 0 &&
           SCOTCH_contextOptionSetNum(&context, SCOTCH_OPTIONNUMRANDOMFIXEDSEED, 1) == 0 &&
           SCOTCH_contextThreadSpawn(&context, 1, nullptr) == 0;
  }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) bool collarmesh_scotch_partition(
    const collarmesh::DualGraph& graph, unsigned partitions, double imbalance, int seed,
    collarmesh::GraphIndex* partition_of) {
  Work work;
  const auto cells = static_cast<SCOTCH_Num>(graph.starts.size() - 1);
  const auto parts = static_cast<SCOTCH_Num>(partitions);
  return work.make_repeatable(seed) &&
         SCOTCH_graphBuild(&work.graph, 0, cells, graph.starts.data(), nullptr, nullptr, nullptr,
                           graph.starts.back(), graph.neighbours.data(), nullptr) == 0 &&
         SCOTCH_contextBindGraph(&work.context, &work.graph, &work.bound) == 0 &&
         SCOTCH_stratGraphMapBuild(&work.strategy, SCOTCH_STRATQUALITY, parts, imbalance) == 0 &&
         SCOTCH_graphPart(&work.bound, parts, &work.strategy, partition_of) == 0;
}
