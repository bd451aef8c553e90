#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "collarmesh/usable_threads.h"
#include "common/median.h"
#include "common/simplices_at_vertex.h"

namespace collarmesh {

double median_edge(const TetMesh& mesh) {
  struct Found {
    EdgesAtVertex at_vertex;
    std::vector<double> lengths;
  };
  tbb::enumerable_thread_specific<Found> of_threads;
  if (tbb::this_task_arena::max_concurrency() > 1)
    static_cast<void>(usable_threads());  // limits TBB to the
                                          // usable threads
  for_each_vertex_with_cells(mesh, [&](std::size_t vertex, std::span<const Index> cells) {
    auto& [at_vertex, lengths] = of_threads.local();
    at_vertex.find(mesh, static_cast<Index>(vertex), cells);
    for (const Index end : at_vertex.ends())
      lengths.push_back(distance(mesh.points[vertex], mesh.points[end]));
  });
  std::vector<double> lengths;
  for (const auto& some : of_threads) lengths.insert(lengths.end(), some.lengths.begin(), some.lengths.end());
  return median(lengths);
}

}  // namespace collarmesh
