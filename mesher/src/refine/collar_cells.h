#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "collar/collar_system.h"
#include "common/growing_array.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// Which cells lie inside the collars, and which vertices are near them.
///
/// Invariants: a cell is inside when its circumcentre lies in a ball, or when it was taken in; a vertex v is
/// near when B(v, R_v), which holds the circumcentres of its cells, meets a ball. The mark may be stale,
/// because cells become smaller, but is never missing. Cells inside are none of refinement's business: all
/// parts ask. The loop tells of insertions, CollarCreator of new balls, CollarReview takes in.
class CollarCells {
 public:
  /// Both are kept by reference. Without balls all functions are cheap.
  CollarCells(const RefinedMesh& mesh, const CollarSystem& collars) : mesh_(mesh), collars_(collars) {}

  bool inside(Index cell) const { return cell < inside_.size() && inside_[cell] != 0; }
  bool near(Index vertex) const { return vertex < near_.size() && near_[vertex] != 0; }
  /// Is any vertex of a zone near?
  bool any_near(const ConflictZone& zone) const;
  /// Does a ball contain a point that lies in the Voronoi cells of all these vertices?
  bool holds(const std::array<Index, 3>& vertices, const Point& p) const;

  void cells_made(const ConflictZone& zone, Index vertex);
  /// Before cells are made between vertices none of which is near: room for all.
  void fit_mesh();
  /// One of these. Several threads may tell of several cells.
  void quiet_cell_made(Index cell) {
    if (cell < inside_.size()) inside_[cell] = 0;
  }

  /// New balls: this vertex, or the circumcentre of this cell, may lie in one.
  void note_near(Index vertex);
  void note_inside(Index cell);
  /// Finds out anew which of the near vertices still are.
  void forget_far_vertices();

  /// A cell that lies outside all balls is given to the collar of one.
  void take_in(Index cell, Index ball);
  /// The ball that a cell was given to, none if it was not.
  Index taken_in_by(Index cell) const;

  std::size_t bytes() const { return inside_.bytes() + near_.bytes(); }

 private:
  struct TakenIn {
    Index ball;
    std::uint32_t generation;  // of the cell
  };

  const RefinedMesh& mesh_;
  const CollarSystem& collars_;
  GrowingArray<std::uint8_t> inside_, near_;     // by cell, by vertex: flags; empty without balls
  std::unordered_map<Index, TakenIn> taken_in_;  // by cell
  std::vector<Index> balls_;                     // near the last vertex
  Index last_vertex_ = none;                     // none when there are more
  std::vector<Index> cells_;                     // scratch
};

}  // namespace collarmesh
