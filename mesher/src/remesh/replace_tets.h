#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "remesh/editable_mesh.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing {

/// A tet to remove, whatever its quality.
struct UnwantedTet {
  Index tet;
  std::array<Index, 2> edge{none, none};  ///< the edge on which to try a vertex before anything else; none:
                                          ///< no edge is preferred
};

/// Removes tets one after the other, so that all tets in their place have at least the quality
/// `least_quality` by the rule: inserts a vertex on an edge, which lies on no curve or smooth patch unless
/// `UnwantedTet::edge` names it, or removes an edge. Then repairs new tets that are too poor, by removing
/// more edges and by moving vertices inside regions; if some stay too poor, undoes all this and keeps the
/// tet. Vertices keep their numbers; new ones follow. Returns how many of the unwanted tets are gone.
/// Precondition: the mesh has `features`.
std::size_t replace_tets(EditableMesh& edited, std::span<const UnwantedTet> unwanted, const ShapeRule& rule,
                         double least_quality);

}  // namespace collarmesh::remeshing
