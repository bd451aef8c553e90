#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/repair.h"
#include "facets/complex_draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// A small feature chosen for collapse, and an edge or a triangle of it in the draft.
struct CollapsedFeature {
  SmallFeature feature;
  facets::Corners corners{none, none, none};  ///< sorted; the last one of an edge is `none`
};

/// Finds the features of `plc` that are smaller than `size` (absolute), and collapses them in `draft`, from
/// which `plc` was built: curves to points, narrow patches and sharp tips of patches to curves. Keeps the
/// features that `kept_patches` and `kept_curves` of the options name, curves with names, the patches of a
/// tag if all of them are small, and patches around regions thinner than the size. Returns the features that
/// it chose for collapse. Some of them may stay or be restored later; `gone_from` finds those that are gone.
/// Corners move by less than the size; surfaces stay closed, but facets may intersect. Cost: O(n log n).
std::vector<CollapsedFeature> collapse_in_draft(facets::ComplexDraft& draft, const Plc& plc, double size,
                                                const RepairOptions& options, Work& work);

/// Returns the features whose `corners` are no longer an edge or a triangle of the draft.
std::vector<SmallFeature> gone_from(const facets::ComplexDraft& draft,
                                    const std::vector<CollapsedFeature>& features);

/// Gives the patches and curves of a changed complex the numbers that they had before, if both complexes were
/// numbered by `number_untagged`. New patches and curves get numbers above all old ones.
void keep_numbers(const Plc& before, Plc& after);

}  // namespace collarmesh::repairing
