#pragma once

#include <algorithm>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Sorts by mesh vertices first: there are many vertices, and few entries for each.
template <class T, class VertexOf>
void sort_by_vertex(std::vector<T>& values, std::size_t vertices, const VertexOf& vertex_of) {
  std::vector<Index> end(vertices + 1, 0);
  for (const T& value : values) ++end[vertex_of(value) + 1];
  for (std::size_t v = 1; v <= vertices; ++v) end[v] += end[v - 1];
  std::vector<T> grouped(values.size());
  for (const T& value : values) grouped[end[vertex_of(value)]++] = value;
  const auto first = grouped.begin();
  for (std::size_t v = 0, begin = 0; v < vertices; begin = end[v++])
    std::sort(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end[v]));
  values.swap(grouped);
}

}  // namespace collarmesh
