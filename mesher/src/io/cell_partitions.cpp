#include "io/cell_partitions.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/cells_at_vertices.h"
#include "common/sort_uniquely.h"
#include "io/cell_nodes.h"

namespace collarmesh::io {

namespace {

Index lowest(const TetMesh& mesh) {
  const auto found = std::min_element(mesh.tet_partition.begin(), mesh.tet_partition.end());
  return found == mesh.tet_partition.end() ? 0 : *found;
}

template <std::size_t n>
std::vector<Index> partitions_of_sides(const TetMesh& mesh, const std::vector<std::array<Index, n>>& cells) {
  if (cells.empty()) return {};
  const CellsAtVertices tets_at(mesh.tets, mesh.points.size());
  const Index lowest_of_all = lowest(mesh);
  std::vector<Index> partitions;
  partitions.reserve(cells.size());
  for (const std::array<Index, n>& cell : cells) {
    Index found = none;
    for (const Index t : tets_at[cell[0]]) {
      const auto& tet = mesh.tets[t];
      if (std::all_of(cell.begin(), cell.end(),
                      [&](Index v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); }))
        found = std::min(found, mesh.tet_partition[t]);
    }
    partitions.push_back(found == none ? lowest_of_all : found);
  }
  return partitions;
}

}  // namespace

std::vector<Index> partitions_of_faces(const TetMesh& mesh) { return partitions_of_sides(mesh, mesh.faces); }
std::vector<Index> partitions_of_edges(const TetMesh& mesh) { return partitions_of_sides(mesh, mesh.edges); }

std::vector<Index> partitions_of_points(const TetMesh& mesh) {
  std::vector<Index> partitions(mesh.points.size(), none);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index v : nodes_of_tet(mesh, t))
      partitions[v] = std::min(partitions[v], mesh.tet_partition[t]);
  std::replace(partitions.begin(), partitions.end(), none, lowest(mesh));
  return partitions;
}

std::vector<Index> partition_numbers(const TetMesh& mesh) {
  std::vector<Index> numbers(mesh.tet_partition);
  sort_uniquely(numbers);
  return numbers;
}

std::vector<std::vector<Index>> ghost_tets(const TetMesh& mesh) {
  const CellsAtVertices tets_at(mesh.tets, mesh.points.size());
  const std::vector<Index> numbers = partition_numbers(mesh);
  std::vector<std::vector<Index>> ghosts(numbers.size());
  std::vector<Index> beside;  // the other partitions at the vertices of one tet
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    beside.clear();
    for (const Index v : mesh.tets[t])
      for (const Index other : tets_at[v])
        if (mesh.tet_partition[other] != mesh.tet_partition[t]) beside.push_back(mesh.tet_partition[other]);
    sort_uniquely(beside);
    for (const Index partition : beside)
      ghosts[static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), partition) -
                                      numbers.begin())]
          .push_back(static_cast<Index>(t));
  }
  return ghosts;
}

}  // namespace collarmesh::io
