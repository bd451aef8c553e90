#include "remesh/tet_complex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include "collarmesh/error.h"
#include "common/found_in_ranges.h"
#include "common/groups.h"
#include "common/index_set.h"
#include "common/note_last.h"
#include "common/parallel_for.h"
#include "common/resize_by_all_threads.h"
#include "common/simplices_at_vertex.h"
#include "common/sorted.h"

namespace collarmesh::remeshing {

namespace {

// Compares like ==, but without its call of memcmp.
bool equal(const std::array<Index, 3>& a, const std::array<Index, 3>& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

bool has_face(const std::array<Index, 4>& tet, const std::array<Index, 3>& face) {
  return std::ranges::count_if(tet, [&](Index v) { return v == face[0] || v == face[1] || v == face[2]; }) ==
         3;
}

// Returns the error about an edge without a ring. In a mesh that was rounded or read, tets may be oriented so
// that a walk around the edge never returns to its start.
PlcError no_ring(const Point& p) {
  const std::string message = fmt::format(
      "The tetrahedra at an edge at ({:.9g}, {:.9g}, {:.9g}) form no ring: features there are too near to "
      "each "
      "other for double precision; raise the repair tolerance.",
      p.x, p.y, p.z);
  return PlcError(message, {{PlcFault::Kind::intersection, message, {}, p}});
}

// Stand for deleted faces and edges until `store`.
constexpr std::array<Index, 3> lost_face{none, none, none};
constexpr std::array<Index, 2> lost_edge{none, none};

// Removes the cells that equal `lost`, and their entries in the other arrays.
template <class Cell, class... Of>
void drop(const Cell& lost, std::vector<Cell>& cells, std::vector<Of>&... of_cells) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == lost) continue;
    ((of_cells[kept] = of_cells[i]), ...);
    cells[kept++] = cells[i];
  }
  cells.resize(kept);
  (of_cells.resize(kept), ...);
}

}  // namespace

TetComplex::TetComplex(TetMesh& mesh, const KnownNeighbours& neighbours) : mesh_(mesh) {
  resize_by_all_threads(mesh.tets.size(), tets_, origin_);
  const bool has_balls = !mesh.collar_balls.empty(), alone = tbb::this_task_arena::max_concurrency() == 1;
  vertex_tet_.assign(mesh.points.size(), none);
  constexpr std::array<Index, 4> nothing{none, none, none, none};
  parallel_for_in_chunks(mesh.tets.size(), [&](std::size_t t) {
    const auto& across = neighbours.empty() ? nothing : neighbours[t];
    tets_[t] = {
        mesh.tets[t], across, nothing, mesh.tet_region[t], 0, true, has_balls && mesh.tet_collar[t] != 0};
    origin_[t] = static_cast<Index>(t);
    for (const Index v : mesh.tets[t]) note_last(vertex_tet_[v], static_cast<Index>(t), alone);
  });
  stamps_.assign(tets_.size(), 0);
  link(!neighbours.empty());
  find_pinched_vertices();
  for (Index e = 0; e < mesh.edges.size(); ++e)
    curve_edges_.emplace(edge_key(mesh.edges[e][0], mesh.edges[e][1]), e);
}

// Links neighbours. If `some_are_known`, looks only at sides without a known neighbour, and at sides that may
// be mesh faces because each of their corners is a corner of a mesh face.
void TetComplex::link(bool some_are_known) {
  std::vector<std::uint8_t> on_faces(some_are_known ? mesh_.points.size() : 0, 0);
  if (some_are_known)
    for (const auto& face : mesh_.faces)
      for (const Index v : face) on_faces[v] = 1;
  const auto visit = [&](std::size_t cell, const auto& give) {
    if (cell >= tets_.size()) {
      const auto face = static_cast<Index>(cell - tets_.size());
      const auto [smallest, use] = triangle_use(mesh_.faces[face], face, TriangleUse::listed_face);
      give(smallest, use);
      return;
    }
    const Tet& tet = tets_[cell];
    for (std::uint8_t corner = 0; corner < 4; ++corner) {
      const auto corners = side_corners(tet.corners, corner);
      if (some_are_known && tet.neighbours[corner] != none &&
          (on_faces[corners[0]] & on_faces[corners[1]] & on_faces[corners[2]]) == 0)
        continue;
      const auto [smallest, use] = triangle_use(corners, static_cast<Index>(cell), corner);
      give(smallest, use);
    }
  };
  const auto link_sides = [&](std::span<const TriangleUse> uses) {
    const Index face = uses.back().listed() ? uses.back().cell : none;
    const auto set = [&](const TriangleUse& side, Index beyond) {
      if (side.listed()) return;
      tets_[side.cell].faces[side.corner] = face;
      tets_[side.cell].neighbours[side.corner] = beyond;
    };
    const bool joined = uses.size() > 1 && !uses[1].listed();
    set(uses[0], joined ? uses[1].cell : none);
    if (joined) set(uses[1], uses[0].cell);
  };
  tbb::enumerable_thread_specific<TrianglesAtVertex> of_threads;
  for_each_group<TriangleUse>(mesh_.points.size(), tets_.size() + mesh_.faces.size(), visit,
                              [&](std::size_t, std::span<const TriangleUse> uses) {
                                TrianglesAtVertex& triangles = of_threads.local();
                                triangles.find(uses);
                                triangles.for_each(link_sides);
                              });
}

// Finds pinched vertices. Looks only at vertices on vertices and curves of the complex, because bodies that
// touch without sharing a face touch only there.
void TetComplex::find_pinched_vertices() {
  const auto corners = found_in_ranges<Index>(tets_.size(), [&](std::size_t t, std::vector<Index>& found) {
    for (const Index v : tets_[t].corners)
      if (mesh_.features[v].dimension <= 1) found.push_back(v);
  });
  std::vector<Index> count(mesh_.points.size(), 0);
  for (const Index v : corners) ++count[v];
  std::vector<Index> around;
  for (Index v = 0; v < mesh_.points.size(); ++v) {
    if (mesh_.features[v].dimension > 1 || vertex_tet_[v] == none) continue;
    star(v, around);
    if (around.size() != count[v]) pinched_.insert(v);
  }
}

// Finds the star. Stars are small, so a small table of the tets found is faster than marks.
void TetComplex::star(Index vertex, std::vector<Index>& found) const {
  IndexSet known;
  found.assign(1, vertex_tet_[vertex]);
  known.insert(found[0]);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Tet& tet = tets_[found[i]];
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index next = tet.neighbours[corner];
      if (tet.corners[corner] == vertex || next == none) continue;
      if (known.insert(next)) found.push_back(next);
    }
  }
}

void TetComplex::ring(Index tet, Index a, Index b, Ring& ring) const {
  ring.tets.clear();
  ring.link.clear();
  // Returns the two other corners of a tet, in the order for which (a, b, c, d) is positive.
  const auto others = [&](Index t) {
    // In the positively oriented face opposite a, begin with the corner after b.
    const auto& v = tets_[t].corners;
    const auto face = side_corners(v, place_of(a, v));
    const auto i = static_cast<unsigned>(std::ranges::find(face, b) - face.begin());
    return std::array<Index, 2>{face[(i + 1) % 3], face[(i + 2) % 3]};
  };
  const auto across = [&](Index t, Index opposite) {
    return tets_[t].neighbours[place_of(opposite, tets_[t].corners)];
  };
  // At a boundary, go back to the first tet of the ring.
  Index start = tet;
  std::size_t steps = 0;
  for (Index t = across(tet, others(tet)[1]); t != none && t != tet; t = across(t, others(t)[1])) {
    start = t;
    if (++steps > tets_.size()) throw no_ring(mesh_.points[a]);
  }
  if (across(start, others(start)[1]) != none) start = tet;
  ring.closed = across(start, others(start)[1]) != none;
  for (Index t = start; t != none;) {
    const auto [c, d] = others(t);
    if (ring.tets.size() > tets_.size()) throw no_ring(mesh_.points[a]);
    ring.tets.push_back(t);
    ring.link.push_back(c);
    const Index next = across(t, c);
    if (next == none) ring.link.push_back(d);
    if (next == start) break;
    t = next;
  }
}

unsigned TetComplex::corner_across(Index tet, const std::array<Index, 3>& sorted_face) const {
  const auto& v = tets_[tet].corners;
  for (unsigned i = 0; i < 4; ++i)
    if (v[i] != sorted_face[0] && v[i] != sorted_face[1] && v[i] != sorted_face[2]) return i;
  return 0;
}

Index TetComplex::add_vertex(const Point& p, const TetMesh::VertexFeature& feature) {
  mesh_.points.push_back(p);
  mesh_.features.push_back(feature);
  vertex_tet_.push_back(none);
  return static_cast<Index>(mesh_.points.size() - 1);
}

Index TetComplex::tet_at_edge(Index a, Index b) const {
  std::vector<Index> around;
  star(a, around);
  for (const Index t : around)
    for (const Index v : tets_[t].corners)
      if (v == b) return t;
  return none;
}

bool TetComplex::on_faces(Index a, Index b) const {
  if (on_curve(a, b) || pinched(a)) return true;
  const Index at = tet_at_edge(a, b);
  if (at == none) return false;
  Ring around;
  ring(at, a, b, around);
  for (const Index t : around.tets)
    for (unsigned corner = 0; corner < 4; ++corner)
      if (tets_[t].faces[corner] != none && tets_[t].corners[corner] != a && tets_[t].corners[corner] != b)
        return true;
  return false;
}

// Returns whether a tet and its neighbours agree: each is the other's neighbour across the same triangle,
// both refer to the same face of the mesh there or to none, and the corners are in use.
[[maybe_unused]] static bool consistent(const TetComplex& complex, Index t) {
  const TetComplex::Tet& tet = complex[t];
  for (unsigned corner = 0; corner < 4; ++corner) {
    if (!complex.in_use(tet.corners[corner])) return false;
    const Index beyond = tet.neighbours[corner];
    if (beyond == none) continue;
    const TetComplex::Tet& other = complex[beyond];
    const auto key = sorted(side_corners(tet.corners, corner));
    unsigned back = 0;
    while (back < 4 && !equal(sorted(side_corners(other.corners, back)), key)) ++back;
    if (back == 4 || !other.alive || other.neighbours[back] != t || other.faces[back] != tet.faces[corner])
      return false;
  }
  return tet.alive;
}

std::span<const Index> TetComplex::replace(const Replacement& replacement) {
  const auto& [old, created, old_faces, created_faces] = replacement;
  assert(std::ranges::all_of(old, [this](Index t) { return tets_[t].alive; }));
  open_.clear();
  ++stamp_;
  for (const Index t : old) stamps_[t] = stamp_;
  for (const Index t : old)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index outer = tets_[t].neighbours[corner];
      if (outer != none && stamps_[outer] == stamp_) continue;
      const auto key = sorted(side_corners(tets_[t].corners, corner));
      open_.push_back({key, outer, outer == none ? 0 : corner_across(outer, key), tets_[t].faces[corner]});
    }
  tags_.clear();
  for (const NewTet& tet : created) tags_.emplace_back(tets_[tet.like].region, origin_[tet.like]);
  cavity_vertices_.clear();
  for (const Index t : old) {
    for (const Index v : tets_[t].corners) {
      if (vertex_tet_[v] == none) continue;
      old_vertex_tets_.set(v, none);
      cavity_vertices_.push_back(v);
    }
    Tet& removed = changing(t);
    removed.alive = false;
    ++removed.generation;
    free_.push_back(t);
  }
  created_.clear();
  for (std::size_t i = 0; i < created.size(); ++i) {
    const auto& corners = created[i].corners;
    Index t = static_cast<Index>(tets_.size());
    if (free_.empty()) {
      tets_.push_back({});
      origin_.push_back(none);
      stamps_.push_back(0);
    } else {
      t = old_free_.pop();
    }
    Tet& tet = changing(t);
    tet = {corners, {none, none, none, none}, {none, none, none, none}, tags_[i].first, tet.generation, true,
           false};
    old_origins_.set(t, tags_[i].second);
    created_.push_back(t);
    for (const Index v : corners) old_vertex_tets_.set(v, t);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const auto key = sorted(side_corners(corners, corner));
      const auto open = std::ranges::find_if(open_, [&](const OpenFace& f) { return equal(f.key, key); });
      if (open == open_.end()) {
        open_.push_back({key, t, corner, none});
        continue;
      }
      tet.neighbours[corner] = open->tet;
      tet.faces[corner] = open->face;
      if (open->tet != none) changing(open->tet).neighbours[open->corner] = t;
      *open = open_.back();
      open_.pop_back();
    }
  }
  // At the remaining faces of the border no tet is left on the side of the cavity.
  for (const OpenFace& open : open_) {
    if (open.tet == none) continue;
    changing(open.tet).neighbours[open.corner] = none;
    for (const Index v : open.key) old_vertex_tets_.set(v, open.tet);
  }
  for (const Index v : cavity_vertices_)
    if (vertex_tet_[v] == none) lost_vertices_.push_back(v);
  make_faces(replacement);
  assert(std::ranges::all_of(created_, [&](Index t) { return consistent(*this, t); }));
  return created_;
}

void TetComplex::make_faces(const Replacement& replacement) {
  created_faces_.clear();
  face_tags_.clear();
  for (const NewFace& face : replacement.created_faces)
    face_tags_.push_back(
        {mesh_.face_patch[face.like], mesh_.face_tag[face.like], mesh_.face_regions[face.like]});
  for (const Index face : replacement.old_faces) {
    old_faces_.set(face, lost_face);
    old_patches_.set(face, none);
    free_faces_.push_back(face);
  }
  for (std::size_t i = 0; i < replacement.created_faces.size(); ++i) {
    Index face = static_cast<Index>(mesh_.faces.size());
    if (free_faces_.empty()) {
      mesh_.faces.push_back({});
      mesh_.face_patch.push_back(none);
      mesh_.face_tag.push_back(0);
      mesh_.face_regions.push_back({});
    } else {
      face = old_free_faces_.pop();
    }
    old_faces_.set(face, replacement.created_faces[i].corners);
    old_patches_.set(face, face_tags_[i].patch);
    old_face_tags_.set(face, face_tags_[i].tag);
    old_face_regions_.set(face, face_tags_[i].regions);
    set_face(mesh_.faces[face], face);
    created_faces_.push_back(face);
  }
}

// Records the index of a mesh face in the tets at this face: the tets that the last replacement made, and
// their neighbours.
void TetComplex::set_face(const std::array<Index, 3>& corners, Index face) {
  const auto key = sorted(corners);
  for (const OpenFace& open : open_)
    if (open.tet != none && equal(open.key, key)) changing(open.tet).faces[open.corner] = face;
  for (const Index t : created_) {
    if (!has_face(tets_[t].corners, key)) continue;
    const unsigned corner = corner_across(t, key);
    changing(t).faces[corner] = face;
    const Index other = tets_[t].neighbours[corner];
    if (other != none) changing(other).faces[corner_across(other, key)] = face;
  }
}

void TetComplex::forget_curve_edge(std::size_t edge) {
  curve_edges_.erase(edge_key(mesh_.edges[edge][0], mesh_.edges[edge][1]));
}

void TetComplex::set_curve_edge(Index edge, const std::array<Index, 2>& ends) {
  forget_curve_edge(edge);
  old_edges_.set(edge, ends);
  if (ends != lost_edge) curve_edges_.emplace(edge_key(ends[0], ends[1]), edge);
}

void TetComplex::join_curve_edges(Index before, Index vertex, Index after) {
  const Index kept = curve_edge(before, vertex), gone = curve_edge(vertex, after);
  std::array<Index, 2> ends = mesh_.edges[kept];  // the kept edge keeps its direction
  std::ranges::replace(ends, vertex, after);
  set_curve_edge(gone, lost_edge);
  set_curve_edge(kept, ends);
}

void TetComplex::divide_curve_edge(Index before, Index vertex, Index after) {
  const Index kept = curve_edge(before, after), added = static_cast<Index>(mesh_.edges.size());
  const auto [first, last] = mesh_.edges[kept];  // both new edges keep its direction
  mesh_.edges.push_back(lost_edge);
  mesh_.edge_curve.push_back(Index{mesh_.edge_curve[kept]});
  mesh_.edge_tag.push_back(Tag{mesh_.edge_tag[kept]});
  set_curve_edge(kept, {first, vertex});
  set_curve_edge(added, {vertex, last});
}

TetComplex::Tet& TetComplex::changing(Index tet) {
  old_tets_.note(tet);
  return tets_[tet];
}

void TetComplex::begin_trial() {
  std::apply([](auto&... log) { (log.begin(), ...); }, logs());
}

void TetComplex::keep() {
  std::apply([](auto&... log) { (log.keep(), ...); }, logs());
}

void TetComplex::undo() {
  for (const auto& [edge, ends] : old_edges_.noted()) forget_curve_edge(edge);
  for (std::size_t edge = old_edges_.size_before(); edge < mesh_.edges.size(); ++edge)
    forget_curve_edge(edge);
  std::apply([](auto&... log) { (log.undo(), ...); }, logs());
  for (const auto& [edge, ends] : old_edges_.noted())
    if (const auto& [a, b] = mesh_.edges[edge]; a != none)
      curve_edges_.emplace(edge_key(a, b), static_cast<Index>(edge));
}

void TetComplex::forget_balls() {
  mesh_.collar_balls.clear();
  for (Tet& tet : tets_) tet.collar = false;
}

void TetComplex::write(TetMesh& mesh) const {
  const auto alive = found_in_ranges<Index>(tets_.size(), [&](std::size_t t, std::vector<Index>& found) {
    if (tets_[t].alive) found.push_back(static_cast<Index>(t));
  });
  TetMesh stored;
  resize_by_all_threads(alive.size(), stored.tets, stored.tet_region, stored.tet_tag, stored.tet_collar,
                        stored.tet_crease);
  parallel_for_in_chunks(alive.size(), [&](std::size_t i) {
    const Index t = alive[i];
    stored.tets[i] = tets_[t].corners;
    stored.tet_region[i] = tets_[t].region;
    stored.tet_tag[i] = mesh.tet_tag[origin_[t]];
    const bool collar = tets_[t].collar;
    stored.tet_collar[i] = collar ? mesh.tet_collar[origin_[t]] : std::uint8_t{0};
    stored.tet_crease[i] = collar ? mesh.tet_crease[origin_[t]] : Tag{0};
  });
  mesh.tets = std::move(stored.tets);
  mesh.tet_region = std::move(stored.tet_region);
  mesh.tet_tag = std::move(stored.tet_tag);
  mesh.tet_collar = std::move(stored.tet_collar);
  mesh.tet_crease = std::move(stored.tet_crease);
  mesh.tet_thin.assign(mesh.tet_thin.empty() ? 0 : mesh.tets.size(), 0);
  drop(lost_face, mesh.faces, mesh.face_patch, mesh.face_tag, mesh.face_regions);
  drop(lost_edge, mesh.edges, mesh.edge_curve, mesh.edge_tag);
  drop_lost_vertices(mesh);
}

void TetComplex::drop_lost_vertices(TetMesh& mesh) const {
  if (lost_vertices_.empty()) return;
  std::vector<Index> all_lost = lost_vertices_;
  std::ranges::sort(all_lost);
  std::vector<Index> number(mesh.points.size());
  Index kept = 0;
  auto lost = all_lost.begin();
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (lost != all_lost.end() && *lost == v) {
      ++lost;
      continue;
    }
    mesh.points[kept] = mesh.points[v];
    mesh.features[kept] = mesh.features[v];
    number[v] = kept++;
  }
  mesh.points.resize(kept);
  mesh.features.resize(kept);
  const auto renumber = [&](auto& cells) {
    parallel_for_in_chunks(cells.size(), [&](std::size_t i) {
      for (Index& point : cells[i]) point = number[point];
    });
  };
  renumber(mesh.tets);
  renumber(mesh.faces);
  renumber(mesh.edges);
  for (TetMesh::CollarBall& ball : mesh.collar_balls) ball.point = number[ball.point];
}

}  // namespace collarmesh::remeshing
