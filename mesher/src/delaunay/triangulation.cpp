#include "delaunay/triangulation.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "common/index_set.h"
#include "common/parallel_for.h"
#include "delaunay/predicates.h"

namespace collarmesh {

namespace {

// Zones with more vertices than this are linked by sorting edges instead of by a square table.
constexpr std::size_t table_limit = 256;

// The five tetrahedra of a box; corner i has bit 0 for x, bit 1 for y, bit 2 for z.
constexpr std::array<std::array<Index, 4>, 5> box_cells{
    {{{0, 1, 2, 4}}, {{3, 2, 1, 7}}, {{5, 1, 4, 7}}, {{6, 4, 2, 7}}, {{1, 2, 4, 7}}}};

}  // namespace

Triangulation::Triangulation(const Box& box) {
  for (unsigned i = 0; i < 8; ++i) {
    const Point p{(i & 1) ? box.max.x : box.min.x, (i & 2) ? box.max.y : box.min.y,
                  (i & 4) ? box.max.z : box.min.z};
    vertices_.push_back({p, none, 0, 0});
  }
  for (auto corners : box_cells) {
    if (predicates::orientation(point(corners[0]), point(corners[1]), point(corners[2]), point(corners[3])) <
        0)
      std::swap(corners[2], corners[3]);
    const Index cell = new_cell();
    cells_[cell] = {corners, {no_face, no_face, no_face, no_face}};
    spheres_[cell] = circumsphere(corners);
    for (const Index v : corners) vertices_[v].cell = cell;
  }
  for (FaceId a = 0; a < 4 * cell_capacity(); ++a)
    for (FaceId b = 0; b < a; ++b) {
      auto fa = face_vertices(a), fb = face_vertices(b);
      std::ranges::sort(fa);
      std::ranges::sort(fb);
      if (fa == fb) link(a, b);
    }
}

std::size_t Triangulation::bytes() const {
  return vertices_.bytes() + cells_.bytes() + spheres_.bytes() + states_.bytes() +
         workspace_.free_cells.capacity() * sizeof(Index) + workspace_.edge_table.capacity() * sizeof(FaceId);
}

void Triangulation::link(FaceId a, FaceId b) {
  cells_[cell_of(a)].neighbours[corner_of(a)] = b;
  cells_[cell_of(b)].neighbours[corner_of(b)] = a;
}

void Triangulation::grow(std::size_t cells) {
  if (cells > (1U << 30)) throw std::length_error("more than 2^30 tetrahedra");
  cells_.extend(cells);
  spheres_.extend(cells);
  states_.extend(cells);
}

Index Triangulation::new_cell() {
  auto& free_cells = workspace_.free_cells;
  if (!free_cells.empty()) {
    const Index cell = free_cells.back();
    free_cells.pop_back();
    return cell;
  }
  const auto cell = static_cast<Index>(cells_.size());
  grow(cell + 1);
  states_[cell] = {0, 0};
  return cell;
}

bool Triangulation::in_conflict_exact(Index cell, const Point& p) const {
  exact_decisions_.fetch_add(1, std::memory_order_relaxed);
  const auto& v = cells_[cell].corners;
  return predicates::in_sphere_exact(point(v[0]), point(v[1]), point(v[2]), point(v[3]), p);
}

// Computes the sphere and its margin. Let e = 2^-53, L the longest edge from the first corner, k = 16 e L^3 /
// |det|, r the radius, c the centre, and |c| its largest coordinate. Centre and radius are off by at most d =
// k (r + L) + 2 e |c| + 4 e r; where they come from exact arithmetic, k is 0 and 2 e |c| becomes 6 e |c|. The
// comparison of the squared distance |pc|^2 of a point p from the centre with r^2 is right if they differ by
// more than 2 d (r + |pc| + d) + 8 e (r^2 + |pc|^2). This is at most margin * (r^2 + |pc|^2) with the margin
// below, because r + |pc| is at most sqrt(2) (r^2 + |pc|^2) / r.
Triangulation::Sphere Triangulation::circumsphere(const std::array<Index, 4>& corners) const {
  constexpr double e = 0x1p-53;
  const Point& a = point(corners[0]);
  const Vector u = point(corners[1]) - a, v = point(corners[2]) - a, w = point(corners[3]) - a;
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  const double longest = std::max({uu, vv, ww});
  const Vector vw = cross(v, w);
  const double det = dot(u, vw);
  double k = 0, of_coordinates = 2 * e;
  Point centre;
  double squared_radius;
  if (det * det < 1e-18 * longest * longest * longest) {
    centre = predicates::circumcentre_exact(a, point(corners[1]), point(corners[2]), point(corners[3]));
    squared_radius = squared_distance(centre, a);
    of_coordinates =
        6 * e;  // two conversions to double, each off by at most a unit in the last place, and a division
  } else {
    const Vector offset = (ww * cross(u, v) + vv * cross(w, u) + uu * vw) / (2 * det);
    centre = a + offset;
    squared_radius = squared_norm(offset);
    k = 16 * e * longest * std::sqrt(longest) / std::fabs(det);
  }
  const double r = std::sqrt(squared_radius);
  const double largest = std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z)});
  const double d = k * (r + std::sqrt(longest)) + of_coordinates * largest + 4 * e * r;
  const double relative = d / r;
  return {centre, squared_radius, 2.83 * relative + 2 * relative * relative + 8 * e};
}

// Prefetches the data that the search reads when it continues from a cell of the zone.
void Triangulation::prefetch_neighbours(Index cell) const {
  for (const FaceId beyond : cells_[cell].neighbours) {
    if (beyond == no_face) continue;
    const Index next = cell_of(beyond);
    __builtin_prefetch(&states_[next]);
    __builtin_prefetch(&spheres_[next]);
    __builtin_prefetch(&cells_[next]);
  }
}

/// Collects the cells in conflict. Returns false when a cell in conflict may not be entered; the zone is then
/// incomplete.
template <class MayEnter>
bool Triangulation::find_zone(const Point& p, Index start, ConflictZone& zone, Workspace& workspace,
                              const MayEnter& may_enter) {
  assert(in_conflict(start, p));
  zone.point = p;
  zone.cells.clear();
  zone.border.clear();
  zone.vertices.clear();
  ++workspace.search;
  const std::uint32_t outside = 2 * workspace.search, inside = 2 * workspace.search + 1;
  const std::uint32_t stamp = ++workspace.vertex_stamp;
  if (!may_enter(start)) return false;
  zone.cells.push_back(start);
  states_[start].mark = inside;
  for (std::size_t i = 0; i < zone.cells.size(); ++i) {
    const Index cell = zone.cells[i];
    for (const Index v : cells_[cell].corners)
      if (stamp_vertex(v, stamp)) zone.vertices.push_back(v);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId beyond = cells_[cell].neighbours[corner];
      if (beyond == no_face) {
        zone.border.push_back(face_id(cell, corner));
        continue;
      }
      const Index next = cell_of(beyond);
      std::uint32_t& mark = states_[next].mark;
      if (mark != inside && mark != outside) {
        mark = in_conflict(next, p) ? inside : outside;
        if (mark == inside) {
          if (!may_enter(next)) return false;
          zone.cells.push_back(next);
          prefetch_neighbours(next);
        }
      }
      if (mark == outside) zone.border.push_back(face_id(cell, corner));
    }
  }
  return true;
}

void Triangulation::find_conflict_zone(const Point& p, Index start, ConflictZone& zone) {
  find_zone(p, start, zone, workspace_, [](Index) { return true; });
}

Index Triangulation::conflicting_cell_around(Index vertex, const Point& p) {
  incident_cells(vertex, scratch_);
  for (const Index cell : scratch_)
    if (in_conflict(cell, p)) return cell;
  return none;
}

// Checks the new cells after an insertion: they must be positively oriented around the vertex, linked to
// their neighbours in both directions, and Delaunay.
[[maybe_unused]] static bool consistent(const Triangulation& mesh, const ConflictZone& zone, Index vertex) {
  for (std::size_t i = 0; i < zone.created.size(); ++i) {
    const Index cell = zone.created[i];
    const auto& v = mesh.corners(cell);
    if (!mesh.alive(cell) || v[corner_of(zone.border[i])] != vertex ||
        predicates::orientation(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])) <= 0)
      return false;
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), beyond = mesh.opposite(face);
      if (beyond == no_face) continue;
      auto ours = mesh.face_vertices(face), theirs = mesh.face_vertices(beyond);
      std::ranges::sort(ours);
      std::ranges::sort(theirs);
      if (mesh.opposite(beyond) != face || ours != theirs ||
          mesh.in_conflict(cell, mesh.point(mesh.corners(cell_of(beyond))[corner_of(beyond)])))
        return false;
    }
  }
  return std::ranges::all_of(zone.vertices, [&](Index v) { return mesh.alive(mesh.incident_cell(v)); });
}

template <class NewCell>
void Triangulation::replace_zone(ConflictZone& zone, Index vertex, Workspace& workspace,
                                 const NewCell& new_cell) {
  vertices_[vertex] = {zone.point, none, 0, 0};
  for (std::size_t i = 0; i < zone.vertices.size(); ++i)
    vertices_[zone.vertices[i]].local = static_cast<std::uint32_t>(i);

  // Build the new cells in fresh or recycled slots. The zone's own cells are still needed here, so only the
  // next insertion recycles them.
  zone.created.clear();
  zone.outer.clear();
  for (const FaceId border : zone.border) {
    const unsigned corner = corner_of(border);
    const Index cell = new_cell();
    Cell made = cells_[cell_of(border)];
    const FaceId beyond = made.neighbours[corner];
    made.corners[corner] = vertex;
    made.neighbours = {no_face, no_face, no_face, no_face};
    made.neighbours[corner] = beyond;
    cells_[cell] = made;
    if (beyond != no_face) cells_[cell_of(beyond)].neighbours[corner_of(beyond)] = face_id(cell, corner);
    spheres_[cell] = circumsphere(made.corners);
    zone.created.push_back(cell);
    zone.outer.push_back(beyond);
    for (const Index v : made.corners) vertices_[v].cell = cell;
  }
  if (zone.vertices.size() <= table_limit)
    link_created(zone, workspace.edge_table);
  else
    link_created_by_sorting(zone);
  for (const Index cell : zone.cells) {
    cells_[cell].corners[0] = none;
    ++states_[cell].generation;
    workspace.free_cells.push_back(cell);
  }
  assert(consistent(*this, zone, vertex));
}

Index Triangulation::insert(ConflictZone& zone) {
  const Index vertex = vertex_count();
  vertices_.push_back({});
  replace_zone(zone, vertex, workspace_, [this] { return new_cell(); });
  return vertex;
}

// Links the new cells. Each directed edge of the border is written once and read once, so the table needs no
// clearing.
void Triangulation::link_created(ConflictZone& zone, std::vector<FaceId>& edge_table) {
  const std::size_t n = zone.vertices.size();
  if (edge_table.size() < n * n) edge_table.resize(n * n);
  for (std::size_t pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < zone.created.size(); ++i) {
      const Index cell = zone.created[i];
      const unsigned apex = corner_of(zone.border[i]);
      const auto& f = opposite_places[apex];
      const auto& corners = cells_[cell].corners;
      const std::array<std::uint32_t, 3> local{vertices_[corners[f[0]]].local, vertices_[corners[f[1]]].local,
                                               vertices_[corners[f[2]]].local};
      for (unsigned k = 0; k < 3; ++k) {
        const std::uint32_t a = local[(k + 1) % 3], b = local[(k + 2) % 3];
        if (pass == 0)
          edge_table[a * n + b] = face_id(cell, f[k]);
        else
          cells_[cell].neighbours[f[k]] = edge_table[b * n + a];
      }
    }
}

void Triangulation::link_created_by_sorting(ConflictZone& zone) {
  struct Edge {
    Index a, b;
    FaceId face;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * zone.created.size());
  for (std::size_t i = 0; i < zone.created.size(); ++i) {
    const Index cell = zone.created[i];
    const auto& f = opposite_places[corner_of(zone.border[i])];
    const auto& corners = cells_[cell].corners;
    for (unsigned k = 0; k < 3; ++k) {
      const Index a = corners[f[(k + 1) % 3]], b = corners[f[(k + 2) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), face_id(cell, f[k])});
    }
  }
  std::ranges::sort(edges, [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) link(edges[i].face, edges[i + 1].face);
}

void Triangulation::incident_cells(Index vertex, std::vector<Index>& cells) {
  cells.clear();
  const std::uint32_t seen = 2 * ++workspace_.search;
  const Index first = vertices_[vertex].cell;
  states_[first].mark = seen;
  cells.push_back(first);
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Cell& cell = cells_[cells[i]];
      if (cell.corners[corner] == vertex || cell.neighbours[corner] == no_face) continue;
      const Index next = cell_of(cell.neighbours[corner]);
      if (states_[next].mark == seen) continue;
      states_[next].mark = seen;
      cells.push_back(next);
    }
}

void Triangulation::adjacent_vertices(Index vertex, std::vector<Index>& adjacent) {
  incident_cells(vertex, scratch_);
  adjacent.clear();
  const std::uint32_t stamp = new_vertex_stamp();
  stamp_vertex(vertex, stamp);
  for (const Index cell : scratch_)
    for (const Index v : cells_[cell].corners)
      if (stamp_vertex(v, stamp)) adjacent.push_back(v);
}

std::vector<Triangulation::Block> Triangulation::divide(std::span<const Index> insertions, Owners& owners) {
  // An insertion makes about seven more cells than it destroys, and makes all new ones before it frees old
  // ones.
  constexpr std::size_t cells_per_insertion = 8, cells_for_a_zone = 256;
  std::vector<Block> blocks(insertions.size());
  std::size_t vertices = vertices_.size(), cells = cells_.size();
  auto& free_cells = workspace_.free_cells;
  for (std::size_t number = 0; number < blocks.size(); ++number) {
    Block& block = blocks[number];
    block.mesh_ = this;
    block.owners_ = &owners;
    block.number_ = static_cast<std::uint16_t>(number);
    block.first_vertex_ = block.next_vertex_ = static_cast<Index>(vertices);
    block.end_vertex_ = static_cast<Index>(vertices += insertions[number]);
    block.workspace_.search = workspace_.search;
    block.workspace_.vertex_stamp = workspace_.vertex_stamp;
    const std::size_t needed =
        insertions[number] == 0 ? 0 : cells_per_insertion * insertions[number] + cells_for_a_zone;
    const std::size_t recycled = std::min(needed, free_cells.size());
    block.workspace_.free_cells.assign(free_cells.end() - static_cast<std::ptrdiff_t>(recycled),
                                       free_cells.end());
    free_cells.resize(free_cells.size() - recycled);
    block.next_cell_ = static_cast<Index>(cells);
    block.end_cell_ = static_cast<Index>(cells += needed - recycled);
  }
  vertices_.extend(vertices);
  grow(cells);
  owners.reserve(vertices);
  for (const Block& block : blocks) owners.resize(block.end_vertex_, block.number_);
  return blocks;
}

Renumbering Triangulation::join(std::vector<Block>& blocks) {
  Renumbering renumbering{{}, vertex_count()};
  if (blocks.empty()) return renumbering;
  const Index before = blocks.front().first_vertex_;
  renumbering.count = before;
  for (const Block& block : blocks) {
    renumbering.moved.push_back(
        {block.first_vertex_, block.next_vertex_, block.first_vertex_ - renumbering.count});
    renumbering.count += block.next_vertex_ - block.first_vertex_;
  }
  renumbering.apply(vertices_);
  parallel_for(blocks.size(), [&](std::size_t i) {
    for (Index cell = blocks[i].next_cell_; cell < blocks[i].end_cell_; ++cell) {
      cells_[cell].corners[0] = none;
      states_[cell] = {0, 0};
    }
    for (const auto& [cell, generation] : blocks[i].created_)
      if (alive(cell) && states_[cell].generation == generation)
        for (Index& v : cells_[cell].corners)
          if (v >= before) v -= renumbering.moved[i].shift;
  });
  for (Block& block : blocks) {
    const Workspace& workspace = block.workspace_;
    workspace_.search = std::max(workspace_.search, workspace.search);
    workspace_.vertex_stamp = std::max(workspace_.vertex_stamp, workspace.vertex_stamp);
    auto& free_cells = workspace_.free_cells;
    for (Index cell = block.end_cell_; cell > block.next_cell_; --cell) free_cells.push_back(cell - 1);
    free_cells.insert(free_cells.end(), workspace.free_cells.begin(), workspace.free_cells.end());
  }
  return renumbering;
}

// At the block's border, this reads only data that no other block changes.
void Triangulation::Block::incident_cells(Index vertex, std::vector<Index>& cells) const {
  cells.assign(1, mesh_->vertices_[vertex].cell);
  IndexSet known;
  known.insert(cells[0]);
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Cell& cell = mesh_->cells_[cells[i]];
      if (cell.corners[corner] == vertex || cell.neighbours[corner] == no_face) continue;
      const Index next = cell_of(cell.neighbours[corner]);
      if (known.insert(next)) cells.push_back(next);
    }
}

bool Triangulation::Block::owns(Index cell) const {
  const auto& corners = mesh_->cells_[cell].corners;
  return std::ranges::all_of(corners, [&](Index v) { return (*owners_)[v] == number_; });
}

bool Triangulation::Block::find_conflict_zone(const Point& p, Index start, ConflictZone& zone) {
  if (next_vertex_ == end_vertex_) return false;
  if (!mesh_->find_zone(p, start, zone, workspace_, [&](Index cell) { return owns(cell); })) return false;
  return workspace_.free_cells.size() + (end_cell_ - next_cell_) >= zone.border.size();
}

Index Triangulation::Block::insert(ConflictZone& zone) {
  assert(next_vertex_ < end_vertex_ &&
         std::ranges::all_of(zone.cells, [this](Index cell) { return owns(cell); }));
  const Index vertex = next_vertex_++;
  auto& free_cells = workspace_.free_cells;
  mesh_->replace_zone(zone, vertex, workspace_, [&] {
    Index cell = none;
    if (free_cells.empty()) {
      cell = next_cell_++;
      mesh_->states_[cell] = {0, 0};
    } else {
      cell = free_cells.back();
      free_cells.pop_back();
    }
    created_.push_back({cell, mesh_->states_[cell].generation});
    return cell;
  });
  return vertex;
}

}  // namespace collarmesh
