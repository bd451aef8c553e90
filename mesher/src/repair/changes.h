#pragma once

#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// What differs between two states of a draft, in places: triangles that are gone or came and hang together
/// by edges. Surfaces stay closed where any of the places is taken back; facets may intersect then.
class Changes {
 public:
  /// The later state has the points of the earlier one, with the same numbers. Both are kept by reference.
  /// Cost: O(n log n).
  Changes(const facets::Draft& before, const facets::Draft& after);

  Index places() const { return places_; }
  /// By triangle of the earlier or later state; none: both have it.
  const std::vector<Index>& place_of_gone() const { return of_gone_; }
  const std::vector<Index>& place_of_come() const { return of_come_; }

  /// The later state, but for the places that are taken back. `place` becomes where its triangles are from;
  /// none: both states have them.
  facets::Draft without(const std::vector<bool>& taken_back, std::vector<Index>& place) const;

 private:
  void match();
  void find_places();
  Index place_at(Index a, Index b) const;
  void mix_segments(const std::vector<bool>& taken_back, facets::Draft& mixed) const;
  void mix_loose_points(const std::vector<bool>& taken_back, facets::Draft& mixed) const;

  const facets::Draft &before_, &after_;
  std::vector<Index> of_gone_, of_come_;
  std::vector<std::pair<std::array<Index, 2>, Index>> edges_;  // of these triangles, and their places; sorted
  Index places_ = 0;
};

}  // namespace collarmesh::repairing
