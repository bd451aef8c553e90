#pragma once

#include <optional>
#include <vector>

#include "common/box_tree.h"
#include "common/disjoint_sets.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// Joins the triangle sides that face each other around an edge: by exact angle if three or more triangles
/// meet there, around the border if there is only one triangle. The resulting sets are the shells of the
/// complex. Their elements are the sides 2 t and 2 t + 1, and one element for the space far outside.
/// Precondition: triangles meet in common edges and corners only.
DisjointSets find_shells(const ComplexDraft& draft, const EdgeTable& edges);

/// A search for the triangles that straight segments cross.
class LineCaster {
 public:
  /// Keeps references to both arguments. The triangles are the first items of the tree, in their order.
  LineCaster(const ComplexDraft& draft, const BoxTree& boxes) : draft_(draft), boxes_(boxes) {}

  struct Crossing {
    Index triangle;
    bool forward;  ///< the line goes from behind the triangle to its front
    Index entry_side() const { return forward ? back_side(triangle) : front_side(triangle); }
    Index exit_side() const { return forward ? front_side(triangle) : back_side(triangle); }
  };
  /// Returns the crossings of the segment pq with triangles, in order from p; nothing if the segment meets an
  /// edge or corner of a triangle, or if p or q lies on a triangle. Exact.
  std::optional<std::vector<Crossing>> cast(const Point& p, const Point& q) const;

 private:
  enum class Meeting { none, forward, backward, degenerate };
  Meeting meet(Index triangle, const Point& p, const Point& q) const;

  const ComplexDraft& draft_;
  const BoxTree& boxes_;
};

/// Returns a direction that is unlikely to be special in any input; a different one for each attempt.
Vector generic_direction(std::size_t attempt);

}  // namespace collarmesh::facets
