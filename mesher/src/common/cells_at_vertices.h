#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A list, for each vertex of a mesh, of the cells (tets, faces or edges) that have it as a corner.
class CellsAtVertices {
 public:
  CellsAtVertices() = default;
  template <std::size_t n>
  CellsAtVertices(const std::vector<std::array<Index, n>>& cells, std::size_t vertices)
      : first_(vertices + 1, 0), cells_(n * cells.size()) {
    for (const auto& cell : cells)
      for (const Index v : cell) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index c = 0; c < cells.size(); ++c)
      for (const Index v : cells[c]) cells_[next[v]++] = c;
  }

  bool empty() const { return first_.empty(); }
  std::span<const Index> operator[](Index vertex) const {
    return std::span(cells_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }

 private:
  std::vector<std::size_t> first_;  // first entry in cells_, by vertex
  std::vector<Index> cells_;
};

}  // namespace collarmesh
