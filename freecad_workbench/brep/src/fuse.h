#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Make closed solids and internal faces that touch share faces, edges and vertices (general fuse), and give
/// what solids have in common to one of them; a note tells which. Solids and faces none of whose faces' boxes
/// meet are left alone. Those whose fuse fails stay as they are, which is told, too: the surfaces have to be
/// cut.
void share_faces(const std::string& file, const CadOptions& options, Topology& topology);

}  // namespace collarmesh::brep
