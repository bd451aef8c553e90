#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Faces without a solid: sewn within 1e-5, 1e-4 and 1e-3 of the diagonal until they enclose something;
/// shells that are closed then become solids. Where there is none, all faces are one solid that is open.
void sew_faces(const std::string& file, Topology& topology);

/// Solids that are open: their faces are sewn in the same way. One that stays open is kept as it is and told
/// in `open_text`.
void close_solids(const std::string& file, Topology& topology);

}  // namespace collarmesh::brep
