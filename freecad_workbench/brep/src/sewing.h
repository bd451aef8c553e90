#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Sews faces without a solid within 1e-5, 1e-4 and 1e-3 of the diagonal until they enclose something; closed
/// shells then become solids. Otherwise all faces become one open solid.
void sew_faces(const std::string& file, Topology& topology);

/// Sews the faces of open solids in the same way. A solid that stays open is kept, and reported in
/// `open_text`.
void close_solids(const std::string& file, Topology& topology);

}  // namespace collarmesh::brep
