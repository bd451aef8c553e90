#pragma once

#include <TopoDS_Shape.hxx>
#include <optional>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Cuts `parts`, which belong to no face, where they meet faces or one another, and inserts vertices or edges
/// into the faces there (general fuse). Updates the topology's solids, internal faces and numbers; pieces
/// have the number of their original. `unchanged` are further parts that keep their numbers. Returns a
/// function that gives the pieces of a part. If the fuse fails or makes a solid unsound (`unsoundness`),
/// returns nothing and leaves the topology unchanged.
std::optional<PartsOf> fuse_free_parts(const std::vector<TopoDS_Shape>& parts,
                                       const std::vector<TopoDS_Shape>& unchanged, Topology& topology);

}  // namespace collarmesh::brep
