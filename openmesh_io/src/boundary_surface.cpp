#include "collarmesh/openmesh_io/boundary_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace collarmesh::openmesh_io {

namespace {

using Triangle = std::array<Index, 3>;

bool matches(const std::array<Index, 2>& regions, const SurfaceSelection& s) {
  const auto is = [](Index region, Index wanted) {
    return wanted == SurfaceSelection::any || region == wanted;
  };
  return regions[0] != regions[1] && is(regions[0], s.back) && is(regions[1], s.front);
}

/// Adds to `surface` the triangles that have the selected regions behind and in front, as they are or when
/// they are reversed.
void select(const TetMesh& mesh, const SurfaceSelection& selection, SelectedSurface& surface) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    Triangle corners = mesh.faces[f];
    std::array<Index, 2> regions = mesh.face_regions[f];
    if (!matches(regions, selection)) {
      std::swap(regions[0], regions[1]);
      std::swap(corners[1], corners[2]);
      if (!matches(regions, selection)) continue;
    }
    surface.triangles.push_back(corners);
    surface.faces.push_back(f);
    surface.face_regions.push_back(regions);
  }
}

/// One side of a triangle, from corner k to corner k + 1.
struct Side {
  Index low, high;  ///< its points
  Index number;     ///< 3 * triangle + k

  auto points() const { return std::pair(low, high); }
};

/// Finds for each side the number that it has in the neighbouring triangle. A side has no neighbour if it
/// belongs to one triangle, to more than two, or to two that are oriented inconsistently.
std::vector<Index> find_neighbours(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  for (Index t = 0; t < triangles.size(); ++t)
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      sides.push_back({low, high, 3 * t + k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.points() != b.points() ? a.points() < b.points() : a.number < b.number;
  });
  const auto from = [&](Index side) { return triangles[side / 3][side % 3]; };
  std::vector<Index> neighbour(3 * triangles.size(), none);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].points() == sides[i].points()) ++end;
    const Index a = sides[i].number, b = sides[end - 1].number;
    if (end - i != 2 || from(a) == from(b)) continue;
    neighbour[a] = b;
    neighbour[b] = a;
  }
  return neighbour;
}

/// Gives each fan of triangles around a point its own vertex.
void separate_fans(const std::vector<Index>& neighbour, SelectedSurface& surface) {
  std::vector<Index> fan(3 * surface.triangles.size());  // union-find: parents, by 3 * triangle + corner
  std::iota(fan.begin(), fan.end(), 0);
  const auto find = [&fan](Index corner) {
    while (fan[corner] != corner) corner = fan[corner] = fan[fan[corner]];
    return corner;
  };
  const auto next = [](Index corner) { return corner / 3 * 3 + (corner + 1) % 3; };
  for (Index side = 0; side < neighbour.size(); ++side) {
    if (neighbour[side] == none) continue;
    fan[find(side)] = find(next(neighbour[side]));
    fan[find(next(side))] = find(neighbour[side]);
  }
  std::vector<Index> vertex(fan.size(), none);
  std::vector<Index> seen;
  std::vector<Triangle> renumbered = surface.triangles;
  for (Index corner = 0; corner < fan.size(); ++corner) {
    const Index root = find(corner), point = surface.triangles[corner / 3][corner % 3];
    if (vertex[root] == none) {
      vertex[root] = static_cast<Index>(surface.points.size());
      surface.points.push_back(point);
    }
    renumbered[corner / 3][corner % 3] = vertex[root];
  }
  surface.triangles = std::move(renumbered);
  seen = surface.points;
  std::sort(seen.begin(), seen.end());
  surface.copied_vertices =
      seen.size() - static_cast<std::size_t>(std::unique(seen.begin(), seen.end()) - seen.begin());
}

/// Orders triangles so that each, except the first of a component, shares an edge with an earlier one; in
/// that order OpenMesh can link all faces.
void order_by_neighbours(const std::vector<Index>& neighbour, SelectedSurface& surface) {
  const std::size_t count = surface.triangles.size();
  std::vector<Index> order;
  std::vector<bool> taken(count, false);
  for (Index start = 0; start < count; ++start) {
    if (taken[start]) continue;
    taken[start] = true;
    order.push_back(start);
    for (std::size_t at = order.size() - 1; at < order.size(); ++at)
      for (Index k = 0; k < 3; ++k) {
        const Index across = neighbour[3 * order[at] + k];
        if (across == none || taken[across / 3]) continue;
        taken[across / 3] = true;
        order.push_back(across / 3);
      }
  }
  SelectedSurface sorted;
  for (const Index t : order) {
    sorted.triangles.push_back(surface.triangles[t]);
    sorted.faces.push_back(surface.faces[t]);
    sorted.face_regions.push_back(surface.face_regions[t]);
  }
  surface.triangles = std::move(sorted.triangles);
  surface.faces = std::move(sorted.faces);
  surface.face_regions = std::move(sorted.face_regions);
}

/// Lists the sides of triangles that lie on curves of the mesh. An edge occurs once for each triangle that
/// has it as a side.
void find_curves(const TetMesh& mesh, SelectedSurface& surface) {
  std::map<std::pair<Index, Index>, Tag> tags;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    tags.emplace(std::minmax(mesh.edges[e][0], mesh.edges[e][1]), mesh.edge_tag[e]);
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      const auto found = tags.find(std::minmax(surface.points[a], surface.points[b]));
      if (found != tags.end()) surface.curves.push_back({a, b, found->second});
    }
}

}  // namespace

SelectedSurface select_surface(const TetMesh& mesh, const SurfaceSelection& selection) {
  SelectedSurface surface;
  select(mesh, selection, surface);
  if (surface.triangles.empty())
    throw OptionError(
        fmt::format("none of the {} boundary and interface triangles of the mesh are selected; "
                    "regions are numbered from 1, 0 is the outside",
                    mesh.faces.size()));
  const std::vector<Index> neighbour = find_neighbours(surface.triangles);
  separate_fans(neighbour, surface);
  order_by_neighbours(neighbour, surface);
  find_curves(mesh, surface);
  return surface;
}

}  // namespace collarmesh::openmesh_io
