#pragma once

#include <vector>

#include "collarmesh/improve.h"
#include "remesh/operations.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing::improvement {

/// A source of operations that may improve a poor tet, in the order in which to try them. Remembers for each
/// vertex whether moving it is known to be useless. Only reads the mesh; several threads may call it at once,
/// each with its own operations.
class OperationChooser {
 public:
  /// Keeps references to the mesh and the rule. `refill`: fill the space around flat tets with new tets where
  /// nothing else helps.
  OperationChooser(const EditableMesh& edited, const SliverRule& rule, const ImproveOptions& options,
                   bool refill = true);

  /// Returns the sine of the dihedral angle up to which tets are improved.
  double wanted() const { return wanted_; }
  double quality(Index tet) const { return rule_.quality(complex_.corners(tet), complex_[tet].corners); }
  /// Returns the quality of a tet that needs improvement; infinite for others.
  double poor_quality(Index tet) const;

  /// Returns the first operation that helps: removal of an edge, move of a corner, edge collapse, insertion;
  /// for a tet that is too obtuse also reconnection, and a collapse that makes longer edges.
  Change propose(Operations& operations, Index tet) const;
  /// Returns whether the tet counts as thin: its radius-edge ratio is above a bound.
  bool is_thin(Index tet) const { return !thin_above_.holds(complex_.corners(tet)); }
  /// Returns whether the tet has an angle above the largest one of thin tets. Proposals for such a tet cost
  /// far more than others, as the space around it is filled anew in many ways.
  bool is_too_obtuse(Index tet) const { return rule_.is_too_obtuse(quality(tet)); }
  /// Returns whether the number of vertices may change at this tet. Walls of a coarsened mesh are one element
  /// thick, which makes their tets poor, but new vertices would undo coarsening. So if vertices are to be
  /// kept, their number may change only at tets that are too obtuse, and at those without a thin tet at
  /// any corner.
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
  // Returns whether the vertex is known to stay. Whether a move helps depends only on the tets at the vertex,
  // so it is not tried again for each of these tets.
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
