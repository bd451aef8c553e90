#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "improve/shape_rule.h"
#include "improve/workpiece.h"

namespace collarmesh::improvement {

/// A tet that is to go, whatever its quality.
struct UnwantedTet {
  Index tet;
  std::array<Index, 2> edge{none, none};  ///< a vertex amid this one would take it apart; none: amid any
};

/// Take tets away, all others staying or becoming as good as `least_quality` by the rule: an edge is removed, or a
/// vertex inserted amid one inside a region or on a planar patch, and what that leaves too poor is mended by more
/// removals and by moving vertices that are on no smooth feature. Tets where that is not enough stay.
/// Returns how many went.
std::size_t replace_tets(Workpiece& workpiece, std::span<const UnwantedTet> unwanted, const ShapeRule& rule,
                         double least_quality);

}  // namespace collarmesh::improvement
