#include "mesh_measures.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace collarmesh::cli {

namespace {

std::size_t bin_of(double value, double width) {
  const double bin = value / width;
  return bin < static_cast<double>(MeshMeasures::bins) ? static_cast<std::size_t>(bin)
                                                       : MeshMeasures::bins - 1;
}

}  // namespace

MeshMeasures measure_mesh(const TetMesh& mesh) {
  MeshMeasures m;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const TetQuality quality = measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    m.min_dihedral = std::min(m.min_dihedral, quality.min_dihedral);
    m.max_dihedral = std::max(m.max_dihedral, quality.max_dihedral);
    m.max_radius_edge = std::max(m.max_radius_edge, quality.radius_edge);
    ++m.min_dihedrals[bin_of(quality.min_dihedral, 10)];
    ++m.max_dihedrals[bin_of(quality.max_dihedral, 10)];
    ++m.radius_edges[bin_of(quality.radius_edge, 0.25)];
    const Index region = t < mesh.tet_region.size() ? mesh.tet_region[t] : 1;
    m.region_volumes[region] += quality.volume;
  }
  return m;
}

double median_edge(const TetMesh& mesh) {
  constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  std::vector<std::uint64_t> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const auto& tet : mesh.tets)
    for (const auto& [i, j] : pairs)
      edges.push_back(std::uint64_t{std::min(tet[i], tet[j])} << 32 | std::max(tet[i], tet[j]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  if (edges.empty()) return 0;
  std::vector<double> lengths(edges.size());
  std::transform(edges.begin(), edges.end(), lengths.begin(), [&](std::uint64_t edge) {
    return distance(mesh.points[edge >> 32], mesh.points[static_cast<Index>(edge)]);
  });
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace collarmesh::cli
