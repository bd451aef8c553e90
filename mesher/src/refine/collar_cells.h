#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "collar/collar_system.h"
#include "common/growing_array.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// The marks of cells inside the collars, and of vertices near them.
/// Invariants: a cell is inside if its circumcentre lies in a collar ball, or if `take_in` added it; a vertex
/// v is near if the smallest ball around v that contains the circumcentres of its cells meets a collar ball.
/// A vertex may be marked as near although it no longer is, because cells become smaller; no mark is missing.
/// Refinement ignores cells inside, so all parts query this class. The loop reports insertions, CollarCreator
/// reports new balls, and CollarReview takes cells in.
class CollarCells {
 public:
  /// Keeps both by reference. Without balls all functions are cheap.
  CollarCells(const RefinedMesh& mesh, const CollarSystem& collars) : mesh_(mesh), collars_(collars) {}

  bool inside(Index cell) const { return cell < inside_.size() && inside_[cell] != 0; }
  bool near(Index vertex) const { return vertex < near_.size() && near_[vertex] != 0; }
  /// Returns whether any vertex of a zone is near.
  bool any_near(const ConflictZone& zone) const;
  /// Returns whether a ball contains p. Precondition: p lies in the Voronoi cells of all these vertices.
  bool holds(const std::array<Index, 3>& vertices, const Point& p) const;

  void cells_made(const ConflictZone& zone, Index vertex);
  /// Makes room for the marks of all cells and vertices. Call it before `quiet_cell_made`.
  void fit_mesh();
  /// Reports a new cell, none of whose vertices is near. Several threads may report different cells.
  void quiet_cell_made(Index cell) {
    if (cell < inside_.size()) inside_[cell] = 0;
  }

  /// Report new balls: this vertex may be near one, or the circumcentre of this cell lies in one.
  void note_near(Index vertex);
  void note_inside(Index cell);
  /// Removes the marks of vertices that are no longer near a ball.
  void forget_far_vertices();

  /// Adds a cell to the collar of a ball, although its circumcentre lies outside all balls.
  void take_in(Index cell, Index ball);
  /// Returns the ball whose collar a cell was added to; none if it was not added to any.
  Index taken_in_by(Index cell) const;

  std::size_t bytes() const { return inside_.bytes() + near_.bytes(); }

 private:
  struct TakenIn {
    Index ball;
    std::uint32_t generation;  // generation of the cell
  };

  const RefinedMesh& mesh_;
  const CollarSystem& collars_;
  GrowingArray<std::uint8_t> inside_, near_;     // flags by cell and by vertex; empty without balls
  std::unordered_map<Index, TakenIn> taken_in_;  // by cell
  std::vector<Index> balls_;                     // balls near last_vertex_
  Index last_vertex_ = none;                     // inserted last; none if balls_ may be incomplete
  std::vector<Index> cells_;                     // scratch
};

}  // namespace collarmesh
