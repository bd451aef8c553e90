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

/// Take tets away, all others there staying or becoming as good as `least_quality` by the rule, one after the
/// other: a vertex is inserted amid an edge inside a region or on a planar patch, or an edge is removed. What
/// that leaves too poor is mended, by more removals and by moving vertices inside regions. Where that is not
/// enough the tet stays. Vertices keep their numbers; new ones follow. Returns how many went, with those that
/// went along. Precondition: the mesh has `features`.
std::size_t replace_tets(Workpiece& workpiece, std::span<const UnwantedTet> unwanted, const ShapeRule& rule,
                         double least_quality);

}  // namespace collarmesh::improvement
