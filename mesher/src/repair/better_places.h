#pragma once

#include <vector>

#include "facets/complex_draft.h"
#include "repair/noise.h"

namespace collarmesh::repairing {

/// The result of `better_places`.
struct BetterPlaces {
  facets::ComplexDraft draft;
  Index places = 0;               ///< number of places where the states differ
  std::vector<Point> taken_back;  ///< a point in each place that was restored
};

/// Combines two valid states of a draft: returns the later one, but restores the places (see `Changes`) that
/// had less trouble before, and places whose facets would intersect those of restored places. The arguments
/// give the troubles of the complexes built from both states. Each trouble counts for the place of the
/// nearest changed triangle within `reach` (absolute). Precondition: as for `Changes`. Cost: O(n log n).
BetterPlaces better_places(const facets::ComplexDraft& before, const std::vector<Trouble>& troubles_before,
                           const facets::ComplexDraft& after, const std::vector<Trouble>& troubles_after,
                           double reach);

}  // namespace collarmesh::repairing
