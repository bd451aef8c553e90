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
  std::array<Index, 2> edge{none, none};  ///< only a vertex on this edge would remove the tet; none: a vertex
                                          ///< on any edge would
};

/// Removes tets one after the other, so that all tets in their place reach the quality `least_quality` of the
/// rule: inserts a vertex on an edge inside a region or on a planar patch, or removes an edge. Then repairs
/// tets that are too poor, by more removals and by moving vertices inside regions; if that is not enough, the
/// tet stays. Vertices keep their numbers; new ones follow. Returns how many of the unwanted tets are gone.
/// Precondition: the mesh has `features`.
std::size_t replace_tets(EditableMesh& edited, std::span<const UnwantedTet> unwanted, const ShapeRule& rule,
                         double least_quality);

}  // namespace collarmesh::remeshing
