#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Calls `found(t, u)` once for each triangle that two tets share, in the order of the triangles' smallest
/// vertices. Cost: linear; temporarily 48 bytes per tet.
template <class Found>
void for_each_shared_face(const TetMesh& mesh, const Found& found) {
  constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
  struct Side {
    Index middle, largest;  // vertices; the smallest one is the group's
    Index tet;
  };
  std::vector<std::size_t> ends(mesh.points.size() + 1, 0);
  const auto sorted_face = [&](std::size_t tet, const std::array<std::size_t, 3>& face) {
    std::array<Index, 3> corners{mesh.tets[tet][face[0]], mesh.tets[tet][face[1]], mesh.tets[tet][face[2]]};
    std::ranges::sort(corners);
    return corners;
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& face : faces) ++ends[sorted_face(t, face)[0] + 1];
  for (std::size_t v = 1; v < ends.size(); ++v) ends[v] += ends[v - 1];
  std::vector<Side> sides(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)  // at the end, ends[v] is the end of the group of v
    for (const auto& face : faces) {
      const auto [smallest, middle, largest] = sorted_face(t, face);
      sides[ends[smallest]++] = {middle, largest, static_cast<Index>(t)};
    }
  std::size_t begin = 0;
  for (std::size_t v = 0; v + 1 < ends.size(); begin = ends[v++]) {
    const auto group = std::span(sides).subspan(begin, ends[v] - begin);
    std::ranges::sort(group, [](const Side& a, const Side& b) {
      return std::tie(a.middle, a.largest, a.tet) < std::tie(b.middle, b.largest, b.tet);
    });
    for (std::size_t i = 0; i + 1 < group.size(); ++i)
      if (group[i].middle == group[i + 1].middle && group[i].largest == group[i + 1].largest)
        found(group[i].tet, group[i + 1].tet);
  }
}

}  // namespace collarmesh
