#include "delaunay/triangulation.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>

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
      std::sort(fa.begin(), fa.end());
      std::sort(fb.begin(), fb.end());
      if (fa == fb) link(a, b);
    }
}

std::size_t Triangulation::bytes() const {
  return vertices_.bytes() + cells_.bytes() + spheres_.bytes() + states_.bytes() +
         free_cells_.capacity() * sizeof(Index) + edge_table_.capacity() * sizeof(FaceId);
}

void Triangulation::link(FaceId a, FaceId b) {
  cells_[cell_of(a)].neighbours[corner_of(a)] = b;
  cells_[cell_of(b)].neighbours[corner_of(b)] = a;
}

Index Triangulation::new_cell() {
  if (!free_cells_.empty()) {
    const Index cell = free_cells_.back();
    free_cells_.pop_back();
    return cell;
  }
  const auto cell = static_cast<Index>(cells_.size());
  if (cell >= (1U << 30)) throw std::length_error("more than 2^30 tetrahedra");
  cells_.push_back({});
  spheres_.push_back({});
  states_.push_back({0, 0});
  return cell;
}

bool Triangulation::in_conflict_exact(Index cell, const Point& p) const {
  ++exact_decisions_;
  const auto& v = cells_[cell].corners;
  return predicates::in_sphere_exact(point(v[0]), point(v[1]), point(v[2]), point(v[3]), p);
}

// The bound: with e = 2^-53, L the longest edge from the first corner and
// k = 16 e L^3 / |det|, the centre and the radius are off by at most d = k (r + L) + 2 e |c| + 4 e r.
// |p c|^2 is then right when it differs from r^2 by more than 2 d (r + |pc| + d) + 8 e (r^2 + |pc|^2),
// which is at most margin * (r^2 + |pc|^2) with the margin below, because r + |pc| is at most
// sqrt(2) (r^2 + |pc|^2) / r.
Triangulation::Sphere Triangulation::circumsphere(const std::array<Index, 4>& corners) const {
  constexpr double e = 0x1p-53;
  const Point& a = point(corners[0]);
  const Vector u = point(corners[1]) - a, v = point(corners[2]) - a, w = point(corners[3]) - a;
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  const double longest = std::max({uu, vv, ww});
  const Vector vw = cross(v, w);
  const double det = dot(u, vw);
  double k = 0;
  Point centre;
  double squared_radius;
  if (det * det < 1e-18 * longest * longest * longest) {
    centre = predicates::circumcentre_exact(a, point(corners[1]), point(corners[2]), point(corners[3]));
    squared_radius = squared_distance(centre, a);
  } else {
    const Vector offset = (ww * cross(u, v) + vv * cross(w, u) + uu * vw) / (2 * det);
    centre = a + offset;
    squared_radius = squared_norm(offset);
    k = 16 * e * longest * std::sqrt(longest) / std::fabs(det);
  }
  const double r = std::sqrt(squared_radius);
  const double largest = std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z)});
  const double d = k * (r + std::sqrt(longest)) + 2 * e * largest + 4 * e * r;
  const double relative = d / r;
  return {centre, squared_radius, 2.83 * relative + 2 * relative * relative + 8 * e};
}

// What the search reads when it goes on from a cell of the zone.
void Triangulation::prefetch_neighbours(Index cell) const {
  for (const FaceId beyond : cells_[cell].neighbours) {
    if (beyond == no_face) continue;
    const Index next = cell_of(beyond);
    __builtin_prefetch(&states_[next]);
    __builtin_prefetch(&spheres_[next]);
    __builtin_prefetch(&cells_[next]);
  }
}

void Triangulation::find_conflict_zone(const Point& p, Index start, ConflictZone& zone) {
  assert(in_conflict(start, p));
  zone.point = p;
  zone.cells.clear();
  zone.border.clear();
  zone.vertices.clear();
  ++search_;
  const std::uint32_t outside = 2 * search_, inside = 2 * search_ + 1;
  const std::uint32_t stamp = new_vertex_stamp();
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
          zone.cells.push_back(next);
          prefetch_neighbours(next);
        }
      }
      if (mark == outside) zone.border.push_back(face_id(cell, corner));
    }
  }
}

Index Triangulation::conflicting_cell_around(Index vertex, const Point& p) {
  incident_cells(vertex, scratch_);
  for (const Index cell : scratch_)
    if (in_conflict(cell, p)) return cell;
  return none;
}

Index Triangulation::insert(ConflictZone& zone) {
  const Index vertex = vertex_count();
  vertices_.push_back({zone.point, none, 0, 0});
  for (std::size_t i = 0; i < zone.vertices.size(); ++i)
    vertices_[zone.vertices[i]].local = static_cast<std::uint32_t>(i);

  // Build the new cells in fresh or recycled slots; the zone's own are still read meanwhile, so
  // those are recycled for the next insertion.
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
    link_created(zone);
  else
    link_created_by_sorting(zone);
  for (const Index cell : zone.cells) {
    cells_[cell].corners[0] = none;
    ++states_[cell].generation;
    free_cells_.push_back(cell);
  }
  return vertex;
}

// Each directed edge of the border is written once and read once, so the table needs no clearing.
void Triangulation::link_created(ConflictZone& zone) {
  const std::size_t n = zone.vertices.size();
  if (edge_table_.size() < n * n) edge_table_.resize(n * n);
  for (std::size_t pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < zone.created.size(); ++i) {
      const Index cell = zone.created[i];
      const unsigned apex = corner_of(zone.border[i]);
      const auto& f = face_corners[apex];
      const auto& corners = cells_[cell].corners;
      const std::array<std::uint32_t, 3> local{vertices_[corners[f[0]]].local, vertices_[corners[f[1]]].local,
                                               vertices_[corners[f[2]]].local};
      for (unsigned k = 0; k < 3; ++k) {
        const std::uint32_t a = local[(k + 1) % 3], b = local[(k + 2) % 3];
        if (pass == 0)
          edge_table_[a * n + b] = face_id(cell, f[k]);
        else
          cells_[cell].neighbours[f[k]] = edge_table_[b * n + a];
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
    const auto& f = face_corners[corner_of(zone.border[i])];
    const auto& corners = cells_[cell].corners;
    for (unsigned k = 0; k < 3; ++k) {
      const Index a = corners[f[(k + 1) % 3]], b = corners[f[(k + 2) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), face_id(cell, f[k])});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) link(edges[i].face, edges[i + 1].face);
}

void Triangulation::incident_cells(Index vertex, std::vector<Index>& cells) {
  cells.clear();
  ++search_;
  const std::uint32_t seen = 2 * search_;
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

}  // namespace collarmesh
