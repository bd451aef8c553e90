#pragma once

#include <vector>

#include "facets/draft.h"
#include "repair/noise.h"

namespace collarmesh::repairing {

/// What `better_places` keeps.
struct BetterPlaces {
  facets::Draft draft;
  Index places = 0;               ///< that differ
  std::vector<Point> taken_back;  ///< a point in each place that is as before
};

/// The later one of two valid states of a draft, but for the places that had less trouble before, and those
/// that meet them. The troubles are those of the complexes of both states, and belong to the changed
/// triangle that is nearest, within `reach` (absolute). Precondition: as of `Changes`. Cost: O(n log n).
BetterPlaces better_places(const facets::Draft& before, const std::vector<Trouble>& troubles_before,
                           const facets::Draft& after, const std::vector<Trouble>& troubles_after,
                           double reach);

}  // namespace collarmesh::repairing
