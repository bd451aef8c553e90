#pragma once

#include <BOPAlgo_Builder.hxx>
#include <memory>
#include <string>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Lets closed solids and internal faces share faces, edges and vertices where they touch (general fuse), and
/// assigns the common part of solids to one of them or to a new region, with a note. Leaves out a solid or an
/// internal face if the boxes of its faces do not meet those of another one. Solids whose fuse fails stay
/// unchanged, with a note; their triangles must be cut later.
void share_faces(const std::string& file, const CadOptions& options, Topology& topology);

using Fuse = std::shared_ptr<BOPAlgo_Builder>;

/// Runs OpenCASCADE's general fuse, after which shapes that meet share their common parts. Returns null if it
/// fails.
Fuse general_fuse(const std::vector<TopoDS_Shape>& shapes);

/// Returns the relative difference between the volume of a solid and that of its parts after a fuse; 0 if the
/// solid is unchanged, infinite if a part is open or none is left.
double unsoundness(BOPAlgo_Builder& fuse, const TopoDS_Shape& solid);

/// The largest unsoundness that errors of the integrals over trimmed faces can explain.
constexpr double rough_volume = 1e-3;

/// Merges pieces into one region with this number, without the faces that two of the pieces share.
Topology::Solid merged(const std::vector<TopoDS_Shape>& pieces, int number);

}  // namespace collarmesh::brep
