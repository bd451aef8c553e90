#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "collarmesh/usable_threads.h"
#include "common/groups.h"

namespace collarmesh {

namespace {

// Works in place. A linear search is faster than sorting, as few edges end at a vertex.
std::span<const Index> without_repeats(std::span<Index> items) {
  constexpr std::size_t few = 256;
  if (items.size() > few) {
    std::sort(items.begin(), items.end());
    return {items.begin(), std::unique(items.begin(), items.end())};
  }
  std::size_t kept = 0;
  for (const Index item : items) {
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::find(items.begin(), end, item) == end) items[kept++] = item;
  }
  return items.first(kept);
}

}  // namespace

double median_edge(const TetMesh& mesh) {
  constexpr std::array<std::array<unsigned, 2>, 6> pairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  // The larger ends of all edges, in groups by the smaller one.
  const auto visit = [&](std::size_t t, const auto& give) {
    const auto& tet = mesh.tets[t];
    for (const auto& [i, j] : pairs) give(std::min(tet[i], tet[j]), std::max(tet[i], tet[j]));
  };
  tbb::enumerable_thread_specific<std::vector<double>> of_threads;
  const auto measure = [&](std::size_t smaller, std::span<Index> larger) {
    std::vector<double>& lengths = of_threads.local();
    for (const Index end : without_repeats(larger))
      lengths.push_back(distance(mesh.points[smaller], mesh.points[end]));
  };
  if (tbb::this_task_arena::max_concurrency() > 1) static_cast<void>(usable_threads());  // keeps TBB to them
  for_each_group<Index>(mesh.points.size(), mesh.tets.size(), visit, measure);
  std::vector<double> lengths;
  for (const auto& some : of_threads) lengths.insert(lengths.end(), some.begin(), some.end());
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace collarmesh
