#pragma once

#include <BOPAlgo_Builder.hxx>
#include <memory>
#include <string>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Where closed solids and internal faces touch, lets them share faces, edges and vertices (general fuse),
/// and assigns the common part of solids to one of them or to a new region, with a note. Leaves out solids
/// and faces if the boxes of their faces meet no boxes of other solids and faces. Solids whose fuse fails
/// stay unchanged, with a note; their surfaces must be cut later.
void share_faces(const std::string& file, const CadOptions& options, Topology& topology);

using Fuse = std::shared_ptr<BOPAlgo_Builder>;

/// Runs OpenCASCADE's general fuse: shapes that meet share their common parts. Null if it fails.
Fuse general_fuse(const std::vector<TopoDS_Shape>& shapes);

/// Returns the relative difference between the volume of a solid and that of its parts; 0 if it is unchanged,
/// infinite if a part is open or none is left.
double unsoundness(BOPAlgo_Builder& fuse, const TopoDS_Shape& solid);

/// Largest unsoundness that errors in integrals over trimmed faces can explain.
constexpr double rough_volume = 1e-3;

/// Returns one region that consists of several pieces, without the faces that two of them share.
Topology::Solid merged(const std::vector<TopoDS_Shape>& pieces, int number);

}  // namespace collarmesh::brep
