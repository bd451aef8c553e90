#pragma once

#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// The difference between two states of a draft, divided into places. A place is a set of removed or added
/// triangles that are connected by edges. If the changes at a place are undone, surfaces stay closed, but
/// facets may intersect.
class Changes {
 public:
  /// Keeps references to both arguments. Precondition: the later state has the points of the earlier one,
  /// with the same numbers. Cost: O(n log n).
  Changes(const facets::ComplexDraft& before, const facets::ComplexDraft& after);

  Index places() const { return places_; }
  /// Return, for each triangle of the earlier (`gone`) or the later (`come`) state, its place; none if both
  /// states have the triangle.
  const std::vector<Index>& place_of_gone() const { return of_gone_; }
  const std::vector<Index>& place_of_come() const { return of_come_; }

  /// Returns the later state with the changes at some places undone. Sets `place` to the place of each
  /// triangle of the result; none for a triangle that both states have.
  facets::ComplexDraft without(const std::vector<bool>& taken_back, std::vector<Index>& place) const;

 private:
  void match();
  void find_places();
  Index place_at(Index a, Index b) const;
  void mix_segments(const std::vector<bool>& taken_back, facets::ComplexDraft& mixed) const;
  void mix_loose_points(const std::vector<bool>& taken_back, facets::ComplexDraft& mixed) const;

  const facets::ComplexDraft &before_, &after_;
  std::vector<Index> of_gone_, of_come_;
  std::vector<std::pair<std::array<Index, 2>, Index>> edges_;  // edges of changed triangles, and their
                                                               // places; sorted
  Index places_ = 0;
};

/// Returns the later state without the changes at the places in `taken_back` and at all other places whose
/// facets would meet other facets outside of common edges and corners; adds those other places to
/// `taken_back`. Facets that already meet in the earlier state may still meet. Takes back all places if more
/// than a few rounds are needed. Cost: O(n log n) for each round.
facets::ComplexDraft without_what_meets(const Changes& changes, std::vector<bool>& taken_back);

}  // namespace collarmesh::repairing
