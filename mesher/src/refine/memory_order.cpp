#include "refine/memory_order.h"

#include <algorithm>

#include "common/renumber_points.h"
#include "common/spatial_order.h"

namespace collarmesh {

namespace {

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& order) {
  if (values.empty()) return;
  std::vector<T> permuted;
  permuted.reserve(values.capacity());
  for (const Index i : order) permuted.push_back(values[i]);
  values = std::move(permuted);
}

/// The cells by their least points, those that share it as they were.
template <std::size_t corners>
std::vector<Index> order_by_least_point(const std::vector<std::array<Index, corners>>& cells,
                                        std::size_t points) {
  std::vector<Index> next(points + 1, 0), order(cells.size());
  const auto least = [](const auto& cell) { return *std::min_element(cell.begin(), cell.end()); };
  for (const auto& cell : cells) ++next[least(cell) + 1];
  for (std::size_t p = 0; p < points; ++p) next[p + 1] += next[p];
  for (Index c = 0; c < cells.size(); ++c) order[next[least(cells[c])]++] = c;
  return order;
}

}  // namespace

void order_in_memory(TetMesh& mesh) {
  std::vector<Index> order, number(mesh.points.size());
  order.reserve(mesh.points.size());
  for (const SpatialKey& key : spatial_order(mesh.points)) {
    number[key.item] = static_cast<Index>(order.size());
    order.push_back(key.item);
  }
  permute(mesh.points, order);
  permute(mesh.features, order);
  renumber_points(mesh, number);

  order = order_by_least_point(mesh.tets, mesh.points.size());
  permute(mesh.tets, order);
  permute(mesh.tet_region, order);
  permute(mesh.tet_tag, order);
  permute(mesh.tet_collar, order);
  permute(mesh.tet_thin, order);
  permute(mesh.tet_crease, order);
  permute(mesh.tet_partition, order);
  order = order_by_least_point(mesh.faces, mesh.points.size());
  permute(mesh.faces, order);
  permute(mesh.face_regions, order);
  permute(mesh.face_patch, order);
  permute(mesh.face_tag, order);
}

}  // namespace collarmesh
