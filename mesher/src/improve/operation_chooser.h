#pragma once

#include <vector>

#include "collarmesh/improve.h"
#include "remesh/operations.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing::improvement {

/// A chooser of the operation that improves a poor tet. Remembers the vertices that no move helps. Only reads
/// the mesh. Several threads may call `propose` at once, each with its own operations.
class OperationChooser {
 public:
  /// Keeps references to the mesh and the rule. `refill`: fill the space around flat tets anew if nothing
  /// else helps.
  OperationChooser(const EditableMesh& edited, const SliverRule& rule, const ImproveOptions& options,
                   bool refill = true);

  /// Returns the sine of the dihedral angle up to which tets are improved.
  double wanted() const { return wanted_; }
  double quality(Index tet) const { return rule_.quality(complex_.corners(tet), complex_[tet].corners); }
  /// Returns the quality of a tet if it needs improvement, else infinity.
  double poor_quality(Index tet) const;

  /// Returns the first operation that helps: removal of an edge, move of a corner, edge collapse, insertion
  /// on an edge; for a tet that is too obtuse also reconnection, and a collapse that makes longer edges.
  Change propose(Operations& operations, Index tet) const;
  /// Returns whether the tet counts as thin: its radius-edge ratio is above a bound.
  bool is_thin(Index tet) const { return !thin_above_.holds(complex_.corners(tet)); }
  /// Returns whether the tet is too obtuse (`SliverRule::is_too_obtuse`). Proposals for such a tet cost far
  /// more than for others, because the space around it is filled anew in many ways.
  bool is_too_obtuse(Index tet) const { return rule_.is_too_obtuse(quality(tet)); }
  /// Returns whether the number of vertices may change at this tet. Walls of a coarsened mesh are one element
  /// thick, which makes their tets poor, but new vertices would undo coarsening. So if vertices are to be
  /// kept, their number may change only at tets that are too obtuse, and at tets whose corners touch no thin
  /// tet.
  bool may_change_vertices(Index tet) const;

  /// Records that no operation helps this tet until something changes at its vertices.
  void nothing_helps(Index tet) { set_stays(tet, move_vertices_); }
  /// Records that the tet is new or that one of its corners has moved.
  void changed(Index tet) { set_stays(tet, false); }
  /// Forgets all records of `nothing_helps`, for example because the rule asks for smaller gains. Until
  /// `nothing_helps` is called again, proposals depend on the mesh alone.
  void forget() { stays_.clear(); }
  bool has_forgotten() const { return stays_.empty(); }

 private:
  // Returns whether no move of the vertex helps. This depends only on the tets at the vertex, so if moves
  // were tried for one of them, they need not be tried for the others.
  bool stays(Index vertex) const { return vertex < stays_.size() && stays_[vertex]; }
  void set_stays(Index tet, bool stays);

  const TetComplex& complex_;
  const SliverRule& rule_;
  RadiusEdgeBound thin_above_;
  double wanted_;
  bool move_vertices_, keep_vertices_, refill_;
  std::vector<bool> stays_;  // by vertex: no move of it helps, and nothing at it has changed since
};

}  // namespace collarmesh::remeshing::improvement
