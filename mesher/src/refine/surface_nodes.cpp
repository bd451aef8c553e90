#include "refine/surface_nodes.h"

#include <algorithm>
#include <cmath>

#include "refine/elements.h"

namespace collarmesh {

namespace {

// Nodes of a vertex are filtered again after so many insertions in its star: rarely on the surface, where
// they never run out. In a large star after as many as a share of its cells, because filtering visits all of
// them: a hub with n cells would cost n^2 while they are made.
constexpr std::size_t insertions_between_refreshes = 16;
constexpr std::size_t insertions_between_surface_refreshes = 48;
constexpr std::size_t cells_per_insertion = 4;

}  // namespace

SurfaceNodes::SurfaceNodes(const Domain& domain, const RefinedMesh& mesh)
    : domain_(domain), mesh_(mesh), hierarchy_(domain.points, elements_of(domain.plc)) {
  lists_.resize(mesh_.vertex_count());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) expect_insertions(v, 0);
  if (hierarchy_.empty()) return;
  pool_.push_back(hierarchy_.root());
  for (List& list : lists_) list.count = 1;
}

std::span<const Index> SurfaceNodes::fewest(FaceId face) const {
  const auto v = mesh_.face_vertices(face);
  std::span<const Index> best = at(v[0]);
  for (const Index vertex : {v[1], v[2]})
    if (lists_[vertex].count < best.size()) best = at(vertex);
  return best;
}

void SurfaceNodes::crossings_of_dual_edge(FaceId face,
                                          std::vector<TriangleHierarchy::Crossing>& found) const {
  hierarchy_.crossings(mesh_.circumcentre(cell_of(face)), mesh_.circumcentre(cell_of(mesh_.opposite(face))),
                       fewest(face), found);
}

Index SurfaceNodes::nearest_triangle(const Point& p, Index patch, double& within_squared) const {
  const Plc& plc = domain_.plc;
  Index nearest = none;
  within_squared = hierarchy_.squared_distance_to(p, within_squared, &nearest, [&](Index triangle) {
    return triangle < plc.triangles.size() && plc.triangles[triangle].patch == patch;
  });
  return nearest;
}

// A new vertex' Voronoi cell is cut out of its neighbours' cells: their nodes cover it.
void SurfaceNodes::cells_made(const ConflictZone& zone, Index vertex) {
  lists_.push_back({});
  expect_insertions(vertex, zone.created.size());
  seeds_.clear();
  for (const Index neighbour : zone.vertices) {
    const auto nodes = at(neighbour);
    if (nodes.empty()) continue;
    seeds_.insert(seeds_.end(), nodes.begin(), nodes.end());
    if (lists_[neighbour].insertions_left > 0) --lists_[neighbour].insertions_left;
  }
  if (seeds_.empty()) return;
  find(zone.created);
  store(lists_[vertex]);
  for (const Index neighbour : zone.vertices)
    if (lists_[neighbour].insertions_left == 0) refresh(neighbour);
}

void SurfaceNodes::quiet_vertices_made() {
  lists_.resize(mesh_.vertex_count(), {.insertions_left = insertions_between_refreshes});
}

void SurfaceNodes::expect_insertions(Index vertex, std::size_t star) {
  const std::size_t least = mesh_.feature(vertex).dimension == 3 ? insertions_between_refreshes
                                                                 : insertions_between_surface_refreshes;
  lists_[vertex].insertions_left = static_cast<std::uint16_t>(
      std::min<std::size_t>(std::max(least, star / cells_per_insertion), UINT16_MAX));
}

// Into found_: what covers the elements in the Voronoi cell of a vertex with these cells, by the box of its
// corners, widened by the rounding of circumcentres. Precondition: seeds_ cover them.
void SurfaceNodes::find(const std::vector<Index>& cells) {
  Box box;
  double largest = 0;
  for (const Index cell : cells) {
    box.add(mesh_.circumcentre(cell));
    largest = std::max(largest, mesh_.squared_radius(cell));
  }
  const double radius = std::sqrt(largest), slack = 1e-9 * radius;
  box.min = box.min - Vector{slack, slack, slack};
  box.max = box.max + Vector{slack, slack, slack};
  hierarchy_.nodes_meeting(box, radius, seeds_, found_);
}

void SurfaceNodes::refresh(Index vertex) {
  mesh_.incident_cells(vertex, cells_);
  const auto nodes = at(vertex);
  seeds_.assign(nodes.begin(), nodes.end());
  find(cells_);
  store(lists_[vertex]);
  expect_insertions(vertex, cells_.size());
}

void SurfaceNodes::store(List& list) {
  if (found_.size() > list.count) {
    list.first = static_cast<Index>(pool_.size());
    pool_.append(found_);
  } else {
    std::copy(found_.begin(), found_.end(), &pool_[list.first]);
  }
  list.count = static_cast<Index>(found_.size());
}

}  // namespace collarmesh
