#include "worst_tets.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace collarmesh::cli {

namespace {

constexpr std::size_t listed = 10;  // by each measure

std::vector<Index> worst(const std::vector<TetQuality>& qualities) {
  std::vector<Index> order(qualities.size()), worst;
  std::iota(order.begin(), order.end(), 0);
  const std::size_t count = std::min(listed, order.size());
  const auto add_first = [&](const auto& is_worse) {
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                      is_worse);
    for (std::size_t i = 0; i < count; ++i)
      if (std::find(worst.begin(), worst.end(), order[i]) == worst.end()) worst.push_back(order[i]);
  };
  add_first([&](Index a, Index b) {
    return std::pair(qualities[a].min_dihedral, a) < std::pair(qualities[b].min_dihedral, b);
  });
  add_first([&](Index a, Index b) {
    return std::pair(-qualities[a].max_dihedral, a) < std::pair(-qualities[b].max_dihedral, b);
  });
  return worst;
}

}  // namespace

std::vector<WorstTet> worst_tets(const TetMesh& mesh) {
  std::vector<TetQuality> qualities;
  qualities.reserve(mesh.tets.size());
  for (const auto& t : mesh.tets)
    qualities.push_back(measure(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
  std::vector<WorstTet> tets;
  for (const Index i : worst(qualities)) {
    const auto& t = mesh.tets[i];
    tets.push_back({i,
                    qualities[i].min_dihedral,
                    qualities[i].max_dihedral,
                    {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]}});
  }
  return tets;
}

}  // namespace collarmesh::cli
