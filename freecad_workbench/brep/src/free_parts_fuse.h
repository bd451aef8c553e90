#pragma once

#include <TopoDS_Shape.hxx>
#include <optional>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Cut edges and vertices of no face where they meet faces or one another, and put vertices, or edges, on the
/// faces there (general fuse). The topology's solids, internal faces and numbers are those after it; pieces
/// have the number of what they were cut from. `unchanged`: further ones that keep their numbers.
/// Returns what gives the pieces of a part; nothing where the fuse fails or spoils a solid: then the topology
/// is as it was.
std::optional<PartsOf> fuse_free_parts(const std::vector<TopoDS_Shape>& parts,
                                       const std::vector<TopoDS_Shape>& unchanged, Topology& topology);

}  // namespace collarmesh::brep
