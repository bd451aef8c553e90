#pragma once

#include <BOPAlgo_Builder.hxx>
#include <memory>
#include <string>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Make closed solids and internal faces that touch share faces, edges and vertices (general fuse), and give
/// what solids have in common to one of them; a note tells which. Solids and faces none of whose faces' boxes
/// meet are left alone. Those whose fuse fails stay as they are, which is told, too: the surfaces have to be
/// cut.
void share_faces(const std::string& file, const CadOptions& options, Topology& topology);

using Fuse = std::shared_ptr<BOPAlgo_Builder>;

/// OpenCASCADE's general fuse: shapes that meet share what they have in common. Null when it fails.
Fuse general_fuse(const std::vector<TopoDS_Shape>& shapes);

/// What the parts of a solid lack of its volume or exceed it by, relative; infinite when one is open or none
/// is left.
double unsoundness(BOPAlgo_Builder& fuse, const TopoDS_Shape& solid);

/// The unsoundness that integrals over trimmed faces may err by.
constexpr double rough_volume = 1e-3;

/// A region of several pieces: their walls, which have two of them at their sides, are none of its boundary.
Topology::Solid merged(const std::vector<TopoDS_Shape>& pieces, int number);

}  // namespace collarmesh::brep
