#include "refine/cell_quality.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

// A centre is inserted with a pseudo-random offset of up to this share of its ball's radius.
constexpr double tet_offset = 0.05;
// A cell is flat if six times its volume is below this share of the cube of the longest edge at its first
// corner.
constexpr double least_volume = 1e-11;
// If a new vertex has more cells than this, its narrow cells must keep the radius-edge bound, too. A vertex
// between two lines with m and n vertices may have m n cells; if all radius-edge ratios are bounded, it
// has at most 60.
constexpr std::size_t most_narrow_cells = 80;

struct Shape {
  double shortest_squared_edge;
  bool flat;
};

Shape shape_of(const RefinedMesh& mesh, const std::array<Index, 4>& v) {
  const Point &a = mesh.point(v[0]), &b = mesh.point(v[1]), &c = mesh.point(v[2]), &d = mesh.point(v[3]);
  const Vector ab = b - a, ac = c - a, ad = d - a;
  const double l_ab = squared_norm(ab), l_ac = squared_norm(ac), l_ad = squared_norm(ad);
  const double longest = std::max(std::max(l_ab, l_ac), l_ad), volume = dot(ab, cross(ac, ad));
  const double at_a = std::min(std::min(l_ab, l_ac), l_ad);
  const double others =
      std::min(std::min(squared_distance(b, c), squared_distance(b, d)), squared_distance(c, d));
  return {std::min(at_a, others),
          volume * volume < least_volume * least_volume * longest * longest * longest};
}

}  // namespace

void CellQuality::judge(Index cell, WorkQueue& queue, bool leaves_narrow_cells) const {
  if (collar_cells_.inside(cell)) return judge_in_collar(cell, queue);
  const Index region = surface_.region(cell);
  const auto& v = mesh_.corners(cell);
  const Shape shape = shape_of(mesh_, v);
  const double r2 = mesh_.squared_radius(cell);
  const Point& centre = mesh_.circumcentre(cell);
  const double bound =
      region == 0 ? std::max(domain_.options.exterior_radius_edge, domain_.options.bounds.radius_edge)
                  : domain_.options.bounds.radius_edge;
  const bool skinny = r2 > bound * bound * shape.shortest_squared_edge;
  const auto fills_gap = [&] {
    return (region == 0 && facing_sheets_.is_within(cell, bound)) ||
           (leaves_narrow_cells && is_narrow(cell, region));
  };
  // Cocircular input makes cells whose volume is only rounding noise although their radius-edge ratio is
  // small. Flat cells with all vertices on one patch are handled when the queue is empty.
  if ((skinny || (shape.flat && region != 0 && !mesh_.on_one_patch(v))) && !fills_gap()) {
    if (domain_.in_box(centre)) queue.push(WorkQueue::skinny_cells, r2, {cell, mesh_.generation(cell)});
    return;
  }
  if (region == 0) return;
  const double size = sizes_.asked().cell_radius(region, centre, sizes_.graded(v, std::sqrt(r2)));
  if (r2 > size * size || uneven_at_vertex(cell))
    queue.push(WorkQueue::large_cells, r2, {cell, mesh_.generation(cell)});
}

// Judges a cell in a collar, in the paper's profile only. There the paper ignores the complex, but bounds the
// radius-edge ratio, so that the mesh is well-spaced everywhere.
void CellQuality::judge_in_collar(Index cell, WorkQueue& queue) const {
  if (!domain_.is_papers()) return;
  const double bound = domain_.options.bounds.radius_edge, r2 = mesh_.squared_radius(cell);
  if (r2 > bound * bound * shape_of(mesh_, mesh_.corners(cell)).shortest_squared_edge)
    queue.push(WorkQueue::skinny_cells, r2, {cell, mesh_.generation(cell)});
}

bool CellQuality::is_narrow(Index cell, Index region) const {
  const double gap = facing_sheets_.gap_across(cell);
  return gap < INFINITY && gap < Sizing::narrow_gap_per_size * target_size(cell, region);
}

// Returns the smallest target edge length that applies to the cell, without gradation.
double CellQuality::target_size(Index cell, Index region) const {
  const Sizing& sizing = sizes_.asked();
  const Point& centre = mesh_.circumcentre(cell);
  double size = std::min(sizing.default_size(centre), sizing.region_size(region, centre));
  for (const Index v : mesh_.corners(cell))
    if (const auto& [dimension, feature] = mesh_.feature(v); dimension == 1 || dimension == 2)
      size = std::min(size, sizing.feature_size(dimension, feature, mesh_.point(v)));
  return size;
}

void CellQuality::judge_all() {
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell)) judge(cell, queue_);
}

bool CellQuality::bound_narrow_cells() {
  if (!std::exchange(leaves_narrow_cells_, false)) return false;
  const std::size_t before = queue_.pushed();
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell) && is_narrow(cell, surface_.region(cell))) judge(cell, queue_);
  return queue_.pushed() > before;
}

void CellQuality::cells_made(const ConflictZone& zone, Index vertex) {
  note_edges(zone, vertex);
  const bool leaves_narrow_cells = leaves_narrow_cells_ && zone.created.size() <= most_narrow_cells;
  for (const Index cell : zone.created) judge(cell, queue_, leaves_narrow_cells);
}

// Returns whether a cell violates the bound on the paper's stronger quality measure (section 1.2), which
// compares the cell's circumradius with the shortest edge at each of its vertices.
bool CellQuality::uneven_at_vertex(Index cell) const {
  if (domain_.options.vertex_ratio == 0) return false;
  const auto& v = mesh_.corners(cell);
  double shortest = INFINITY;
  for (const Index vertex : v) shortest = std::min(shortest, shortest_edge_[vertex]);
  const double bound = domain_.options.vertex_ratio * shortest;
  return mesh_.squared_radius(cell) > bound * bound;
}

// Updates the shortest edges. A vertex and its nearest neighbour are always joined, so the shortest edge at a
// vertex never grows. If it shrank, older cells may have become uneven.
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
  Point p = frame.rounded(centre + random.outside_collars(centre, tet_offset * std::sqrt(r2 / 3), {}));
  if (!domain_.in_box(p)) p = frame.rounded(centre);
  if (!domain_.in_box(p) || !mesh_.in_conflict(cell, p)) return std::nullopt;
  return Candidate{p, r2, centre, {3, none}, cell};
}

void CellQuality::queue_again(const WorkQueue::Item& item, double squared_radius) {
  if (mesh_.alive(item.entry.id, item.entry.stamp)) queue_.push(item.priority, squared_radius, item.entry);
}

}  // namespace collarmesh
