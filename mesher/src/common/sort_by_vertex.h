#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns the values `value(i)` for all i below `count`, sorted by `<`, whose first criterion must be
/// `vertex_of(value)`, a number below `vertices`. Groups them by vertex first, because there are many
/// vertices and few values at each.
template <class Value, class VertexOf>
auto sorted_by_vertex(std::size_t count, std::size_t vertices, const Value& value,
                      const VertexOf& vertex_of) {
  std::vector<Index> end(vertices + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++end[vertex_of(value(i)) + 1];
  for (std::size_t v = 1; v <= vertices; ++v) end[v] += end[v - 1];
  std::vector<std::decay_t<decltype(value(0))>> sorted(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& next = value(i);
    sorted[end[vertex_of(next)]++] = next;
  }
  const auto first = sorted.begin();
  for (std::size_t v = 0, begin = 0; v < vertices; begin = end[v++])
    std::sort(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end[v]));
  return sorted;
}

/// Sorts values as `sorted_by_vertex` does.
template <class T, class VertexOf>
void sort_by_vertex(std::vector<T>& values, std::size_t vertices, const VertexOf& vertex_of) {
  values = sorted_by_vertex(
      values.size(), vertices, [&](std::size_t i) -> const T& { return values[i]; }, vertex_of);
}

}  // namespace collarmesh
