#pragma once

#include <optional>
#include <vector>

#include "common/box_tree.h"
#include "common/disjoint_sets.h"
#include "facets/draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// Joins the triangle sides that see each other around an edge: by exact angle where three or more triangles
/// meet, around the border where there is one. The sets are the shells of the complex. They are over the
/// sides 2 t and 2 t + 1, and one more element for the space far outside. Precondition: triangles meet in
/// common edges and corners only.
DisjointSets find_shells(const Draft& draft, const EdgeTable& edges);

/// Where straight lines meet the triangles.
class LineCaster {
 public:
  /// Both are kept by reference. The triangles are the first items of the tree, in their order.
  LineCaster(const Draft& draft, const BoxTree& boxes) : draft_(draft), boxes_(boxes) {}

  struct Crossing {
    Index triangle;
    bool forward;  ///< from behind the triangle to its front
    Index entry_side() const { return forward ? back_side(triangle) : front_side(triangle); }
    Index exit_side() const { return forward ? front_side(triangle) : back_side(triangle); }
  };
  /// The triangles between p and q in order from p; nothing if the line meets an edge or corner of
  /// one, or if p or q lies on one. Exact.
  std::optional<std::vector<Crossing>> cast(const Point& p, const Point& q) const;

 private:
  enum class Meeting { none, forward, backward, degenerate };
  Meeting meet(Index triangle, const Point& p, const Point& q) const;

  const Draft& draft_;
  const BoxTree& boxes_;
};

/// A direction that no input prefers; another one for each attempt.
Vector generic_direction(std::size_t attempt);

}  // namespace collarmesh::facets
