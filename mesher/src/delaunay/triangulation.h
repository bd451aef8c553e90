#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/growing_array.h"
#include "common/tet_sides.h"

namespace collarmesh {

/// A face of a cell: 4 * cell + index of the opposite corner. Names the face from that cell's side.
using FaceId = std::uint32_t;
inline constexpr FaceId no_face = none;
inline Index cell_of(FaceId face) { return face >> 2; }
inline unsigned corner_of(FaceId face) { return face & 3U; }
inline FaceId face_id(Index cell, unsigned corner) { return 4 * cell + corner; }

/// The cells whose circumspheres contain a point, with their border: insertion of the point replaces them.
/// Callers reuse one object, so that insertions soon allocate no more memory.
struct ConflictZone {
  Point point;
  std::vector<Index> cells;
  std::vector<FaceId> border;   ///< faces of the zone's cells towards cells outside the zone, or on the hull
  std::vector<Index> vertices;  ///< vertices of the zone's cells: the new vertex's neighbours
  std::vector<Index> created;   ///< after insert: the new cell over border[i]; the new vertex is its corner
                                ///< opposite that face
  std::vector<FaceId> outer;  ///< after insert: border[i] as a face of the cell outside; no_face on the hull
};

/// The largest numbers of vertices and cells of any replaced zone.
struct LargestZone {
  std::size_t vertices = 0, cells = 0;

  void add(const ConflictZone& zone) { add(LargestZone{zone.vertices.size(), zone.cells.size()}); }
  void add(const LargestZone& other) {
    vertices = std::max(vertices, other.vertices);
    cells = std::max(cells, other.cells);
  }
};

/// The new numbers of vertices after blocks have been joined.
struct Renumbering {
  struct Moved {
    Index first, end;  ///< a range of old numbers
    Index shift;       ///< decrease of the numbers in the range
  };
  std::vector<Moved> moved;  ///< ranges, in their order
  Index count;               ///< number of all vertices

  /// Renumbers an array with an entry for each vertex.
  template <class T>
  void apply(GrowingArray<T>& of_vertices) const {
    for (const auto& [first, end, shift] : moved)
      for (Index v = first; v < end; ++v) of_vertices[v - shift] = of_vertices[v];
    of_vertices.resize(count);
  }
};

/// Delaunay triangulation of points inside a box, as flat arrays.
/// The box's eight corners are vertices 0 to 7; everything stays inside, so there are no infinite cells. A
/// cell is four vertices, positively oriented (`six_volume` > 0), and four neighbours; its circumsphere is
/// stored with an error bound. A point on a circumsphere is not in conflict. Cells are recycled;
/// `generation` tells whether an id still means the same cell.
/// Several threads may insert at once into blocks of vertices, one block each: see `divide`.
class Triangulation {
 public:
  class Block;
  /// For each vertex, the block that it belongs to.
  using Owners = std::vector<std::uint16_t>;
  static constexpr std::uint16_t no_owner = UINT16_MAX;

  explicit Triangulation(const Box& box);

  Index vertex_count() const { return static_cast<Index>(vertices_.size()); }
  /// Returns the number of cells, used and free ones. Every cell id is below it.
  Index cell_capacity() const { return static_cast<Index>(cells_.size()); }
  Index cell_count() const { return static_cast<Index>(cells_.size() - workspace_.free_cells.size()); }

  const Point& point(Index vertex) const { return vertices_[vertex].point; }
  /// Returns a cell with this vertex.
  Index incident_cell(Index vertex) const { return vertices_[vertex].cell; }

  const std::array<Index, 4>& corners(Index cell) const { return cells_[cell].corners; }
  /// Returns the id of the same face in the cell on its other side; no_face on the hull.
  FaceId opposite(FaceId face) const { return cells_[cell_of(face)].neighbours[corner_of(face)]; }
  std::array<Index, 3> face_vertices(FaceId face) const {
    const auto& v = corners(cell_of(face));
    const auto& f = opposite_places[corner_of(face)];
    return {v[f[0]], v[f[1]], v[f[2]]};
  }
  bool alive(Index cell) const { return cells_[cell].corners[0] != none; }
  /// Returns a number that changes whenever the cell is destroyed.
  std::uint32_t generation(Index cell) const { return states_[cell].generation; }

  /// Prefetches the cell's corners and generation.
  void prefetch(Index cell) const {
    __builtin_prefetch(&states_[cell]);
    __builtin_prefetch(&cells_[cell]);
  }

  const Point& circumcentre(Index cell) const { return spheres_[cell].centre; }
  double squared_radius(Index cell) const { return spheres_[cell].squared_radius; }

  /// Returns whether p is strictly inside the cell's circumsphere, always exactly.
  bool in_conflict(Index cell, const Point& p) const {
    const Sphere& s = spheres_[cell];
    const double d = squared_distance(p, s.centre);
    const double difference = s.squared_radius - d;
    if (std::fabs(difference) > s.margin * (s.squared_radius + d)) return difference > 0;
    return in_conflict_exact(cell, p);
  }

  /// Finds all cells in conflict with p. Precondition: `start` is in conflict with p. Cost: linear in the
  /// zone. The zone stays valid until the next insertion.
  void find_conflict_zone(const Point& p, Index start, ConflictZone& zone);

  /// Returns a cell around `vertex` that is in conflict with p; none if there is none. There always is one if
  /// `vertex` is a nearest vertex of p, unless p is a vertex itself.
  Index conflicting_cell_around(Index vertex, const Point& p);

  /// Replaces the zone's cells by cells that join the faces of its border to zone.point. Returns the new
  /// vertex; fills zone.created and zone.outer.
  Index insert(ConflictZone& zone);

  /// Divides the triangulation into blocks of vertices. `insertions` gives for each block the number of
  /// insertions that it gets memory for. Until the blocks are joined, callers may only insert into blocks,
  /// and may only read data that no other block changes: points; corners and spheres of cells with a vertex
  /// of the reader's own block; neighbours of these cells across faces with a vertex of that block. `owners`
  /// gives the block of each vertex, below `insertions.size()`, or `no_owner`; it grows with new vertices,
  /// and must otherwise not change until the blocks are joined. The result does not depend on the threads,
  /// nor on their timing.
  std::vector<Block> divide(std::span<const Index> insertions, Owners& owners);
  /// Joins the blocks and numbers their vertices, block by block.
  Renumbering join(std::vector<Block>& blocks);

  /// Finds the cells with this vertex, in no particular order.
  void incident_cells(Index vertex, std::vector<Index>& cells);
  /// Finds the vertices joined to this one by an edge.
  void adjacent_vertices(Index vertex, std::vector<Index>& adjacent);

  /// Returns a fresh stamp for marking vertices. `stamp_vertex` returns false if a vertex already has the
  /// stamp.
  std::uint32_t new_vertex_stamp() { return ++workspace_.vertex_stamp; }
  bool stamp_vertex(Index vertex, std::uint32_t stamp) {
    if (vertices_[vertex].stamp == stamp) return false;
    vertices_[vertex].stamp = stamp;
    return true;
  }

  std::size_t exact_decisions() const { return exact_decisions_.load(std::memory_order_relaxed); }
  std::size_t bytes() const;

 private:
  struct Vertex {
    Point point;
    Index cell;
    std::uint32_t stamp;
    std::uint32_t local;  // index in the zone's list of vertices, during an insertion
  };
  struct Cell {
    std::array<Index, 4> corners;
    std::array<FaceId, 4> neighbours;
  };
  struct Sphere {
    Point centre;
    double squared_radius;
    double margin;  // relative error bound of the conflict test
  };
  struct State {
    std::uint32_t mark;  // 2 * search: seen and not in conflict; 2 * search + 1: in conflict
    std::uint32_t generation;
  };

  /// The marks, free cells and edge table of one thread that searches and inserts. Marks only increase.
  struct Workspace {
    std::uint32_t search = 0;
    std::uint32_t vertex_stamp = 0;
    std::vector<Index> free_cells;
    std::vector<FaceId> edge_table;
  };

  bool in_conflict_exact(Index cell, const Point& p) const;
  void prefetch_neighbours(Index cell) const;
  Sphere circumsphere(const std::array<Index, 4>& corners) const;
  Index new_cell();
  void grow(std::size_t cells);
  void link(FaceId a, FaceId b);
  template <class MayEnter>
  bool find_zone(const Point& p, Index start, ConflictZone& zone, Workspace& workspace,
                 const MayEnter& may_enter);
  template <class NewCell>
  void replace_zone(ConflictZone& zone, Index vertex, Workspace& workspace, const NewCell& new_cell);
  void link_created(ConflictZone& zone, std::vector<FaceId>& edge_table);
  void link_created_by_sorting(ConflictZone& zone);

  GrowingArray<Vertex> vertices_;
  GrowingArray<Cell> cells_;
  GrowingArray<Sphere> spheres_;
  GrowingArray<State> states_;
  Workspace workspace_;
  mutable std::atomic<std::size_t> exact_decisions_{0};
  std::vector<Index> scratch_;
};

/// A block of vertices. One thread may insert into it while others insert into other blocks.
///
/// A zone lies in a block when all vertices of the zone belong to the block. An insertion then writes the
/// zone's cells, the faces towards cells beyond its border, and marks of these cells. A cell beyond the
/// border has three vertices of the block, so that no other block's zone borders on it: no thread reads or
/// writes data that another one writes.
class Triangulation::Block {
 public:
  /// Finds all cells in conflict with p, as Triangulation::find_conflict_zone does. Returns false if the zone
  /// has a vertex of another block, or if the block has no room for the new vertex or its cells.
  bool find_conflict_zone(const Point& p, Index start, ConflictZone& zone);
  /// Inserts the zone's point. Precondition: the zone lies in this block. The vertex gets another number when
  /// blocks are joined.
  Index insert(ConflictZone& zone);
  /// Finds the cells at a vertex of this block. Leaves no marks on them, because other blocks may have
  /// vertices of these cells, too.
  void incident_cells(Index vertex, std::vector<Index>& cells) const;

 private:
  friend class Triangulation;
  struct Created {
    Index cell;
    std::uint32_t generation;
  };
  bool owns(Index cell) const;

  Triangulation* mesh_;
  const Owners* owners_;
  std::uint16_t number_;
  Index first_vertex_, next_vertex_, end_vertex_;
  Index next_cell_, end_cell_;  // cells that were never used before
  Workspace workspace_;
  std::vector<Created> created_;
};

}  // namespace collarmesh
