#include "refine/cell_quality.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

// The insertion of a centre is moved by a pseudo-random offset of this share of its ball's radius.
constexpr double offset_per_radius = 0.05;
// A cell whose volume is below this share of its longest edge cubed is flat.
constexpr double flat_volume = 1e-11;

double shortest_squared_edge(const RefinedMesh& mesh, Index cell) {
  const auto& v = mesh.corners(cell);
  const Point &a = mesh.point(v[0]), &b = mesh.point(v[1]), &c = mesh.point(v[2]), &d = mesh.point(v[3]);
  return std::min({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d),
                   squared_distance(b, c), squared_distance(b, d), squared_distance(c, d)});
}

}  // namespace

CellQuality::CellQuality(const Domain& domain, const RefinedMesh& mesh, const CollarCells& collar_cells,
                         const RestrictedSurface& surface, const GradedSizes& sizes,
                         const FacingSheets& facing_sheets, RandomOffsets& random, WorkQueue& queue)
    : domain_(domain),
      mesh_(mesh),
      collar_cells_(collar_cells),
      surface_(surface),
      sizes_(sizes),
      facing_sheets_(facing_sheets),
      random_(random),
      queue_(queue) {
  if (domain_.options.vertex_ratio > 0) shortest_edge_.resize(mesh_.vertex_count(), INFINITY);
}

void CellQuality::judge(Index cell, WorkQueue& queue) const {
  if (collar_cells_.inside(cell)) return;
  const Index region = surface_.region(cell);
  const double r2 = mesh_.squared_radius(cell);
  const Point& centre = mesh_.circumcentre(cell);
  const double bound = region == 0
                           ? std::max(domain_.options.exterior_radius_edge, domain_.options.radius_edge)
                           : domain_.options.radius_edge;
  const bool skinny = r2 > bound * bound * shortest_squared_edge(mesh_, cell) &&
                      !(region == 0 && facing_sheets_.fills_gap(cell, bound));
  if (skinny || (region != 0 && flat(cell))) {
    if (domain_.in_box(centre)) queue.push(WorkQueue::skinny_cells, r2, {cell, mesh_.generation(cell)});
    return;
  }
  if (region == 0) return;
  const auto& v = mesh_.corners(cell);
  const double size = sizes_.asked().cell_radius(region, centre, sizes_.graded(v, std::sqrt(r2)));
  if (r2 > size * size || uneven_at_vertex(cell))
    queue.push(WorkQueue::large_cells, r2, {cell, mesh_.generation(cell)});
}

void CellQuality::judge_all() {
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell)) judge(cell, queue_);
}

void CellQuality::cells_made(const ConflictZone& zone, Index vertex) {
  note_edges(zone, vertex);
  for (const Index cell : zone.created) judge(cell, queue_);
}

// Cocircular input makes cells whose volume is noise although their radius-edge ratio is not. Those
// on one patch are seen to when the queue is empty.
bool CellQuality::flat(Index cell) const {
  const auto& v = mesh_.corners(cell);
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  const double longest = std::max({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d)});
  const double volume = six_volume(a, b, c, d);
  return volume * volume < flat_volume * flat_volume * longest * longest * longest && !mesh_.on_one_patch(v);
}

// The paper's stronger quality measure (section 1.2): a circumradius against the shortest edge at a
// vertex.
bool CellQuality::uneven_at_vertex(Index cell) const {
  if (domain_.options.vertex_ratio == 0) return false;
  const auto& v = mesh_.corners(cell);
  double shortest = INFINITY;
  for (const Index vertex : v) shortest = std::min(shortest, shortest_edge_[vertex]);
  const double bound = domain_.options.vertex_ratio * shortest;
  return mesh_.squared_radius(cell) > bound * bound;
}

// The nearest neighbour of a vertex is always joined to it, so the shortest edge at a vertex only
// ever shrinks. Where it did, older cells may have become uneven.
void CellQuality::note_edges(const ConflictZone& zone, Index vertex) {
  if (domain_.options.vertex_ratio == 0) return;
  shortest_edge_.resize(mesh_.vertex_count(), INFINITY);
  for (const Index neighbour : zone.vertices) {
    const double length = distance(mesh_.point(vertex), mesh_.point(neighbour));
    shortest_edge_[vertex] = std::min(shortest_edge_[vertex], length);
    if (length >= shortest_edge_[neighbour]) continue;
    shortest_edge_[neighbour] = length;
    mesh_.incident_cells(neighbour, cells_);
    for (const Index cell : cells_)
      if (surface_.region(cell) != 0 && uneven_at_vertex(cell))
        queue_.push(WorkQueue::large_cells, mesh_.squared_radius(cell), {cell, mesh_.generation(cell)});
  }
}

std::optional<Candidate> CellQuality::candidate(Index cell, RandomOffsets& random) const {
  const double r2 = mesh_.squared_radius(cell);
  const Point& centre = mesh_.circumcentre(cell);
  const Frame& frame = domain_.frame;
  Point p = frame.rounded(centre + random.outside_collars(centre, offset_per_radius * std::sqrt(r2 / 3), {}));
  if (!domain_.in_box(p)) p = frame.rounded(centre);
  if (!domain_.in_box(p) || !mesh_.in_conflict(cell, p)) return std::nullopt;
  return Candidate{p, r2, centre, {3, none}, cell};
}

void CellQuality::queue_again(const WorkQueue::Item& item, double squared_radius) {
  if (mesh_.alive(item.entry.id, item.entry.stamp)) queue_.push(item.priority, squared_radius, item.entry);
}

}  // namespace collarmesh
