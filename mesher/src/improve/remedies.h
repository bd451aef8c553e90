#pragma once

#include <vector>

#include "collarmesh/improve.h"
#include "improve/operations.h"
#include "improve/shape_rule.h"

namespace collarmesh::improvement {

/// What would help a poor tet: which operations are proposed for it, and in which order.
/// State: of each vertex whether moving it is known to be of no use. Of the mesh it only reads; several
/// threads may ask at once, each with operations of its own.
class Remedies {
 public:
  /// Both are kept by reference.
  Remedies(const Workpiece& workpiece, const SliverRule& rule, const ImproveOptions& options);

  /// The sine of the angle that tets are improved to.
  double wanted() const { return wanted_; }
  double quality(Index tet) const { return rule_.quality(complex_.corners(tet), complex_[tet].corners); }
  /// Quality of a tet that is to be improved; infinite for others.
  double poor_quality(Index tet) const;

  /// The first that helps of: an edge removed, a corner moved, an edge contracted, a vertex inserted.
  Change propose(Operations& operations, Index tet) const;
  /// Will the tet be called thin?
  bool is_thin(Index tet) const { return !thin_above_.holds(complex_.corners(tet)); }
  /// May the number of vertices change at this tet? In a coarsened mesh walls are one element thick and tets
  /// at them poor for that; vertices would bring back what has been removed. So only tets beyond the largest
  /// angle of thin ones may change their number there, and all where no thin tet is near.
  bool may_change_vertices(Index tet) const;

  /// Nothing helps this tet, as long as nothing changes at its vertices.
  void nothing_helps(Index tet) { set_stays(tet, move_vertices_); }
  /// The tet is new, or a corner of it has moved.
  void changed(Index tet) { set_stays(tet, false); }
  /// All may help again, as when the rule asks for less. As long as `nothing_helps` is not called, what is
  /// proposed depends on the mesh alone.
  void forget() { stays_.clear(); }

 private:
  // Whether a move helps depends on the tets at the vertex alone, each of which may ask.
  bool stays(Index vertex) const { return vertex < stays_.size() && stays_[vertex]; }
  void set_stays(Index tet, bool stays);

  const TetComplex& complex_;
  const SliverRule& rule_;
  RadiusEdgeBound thin_above_;
  double wanted_;
  bool move_vertices_, keep_vertices_;
  std::vector<bool> stays_;  // by vertex: no move of it helps, and nothing at it has changed since
};

}  // namespace collarmesh::improvement
