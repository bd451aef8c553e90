#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Sews faces of no solid within 1e-5, 1e-4 and 1e-3 of the diagonal, until they enclose something. Closed
/// shells then become solids. If nothing is enclosed, all faces become one open solid.
void sew_faces(const std::string& file, Topology& topology);

/// Sews the faces of open solids in the same way. Solids that stay open are kept, and described in
/// `open_text`.
void close_solids(const std::string& file, Topology& topology);

}  // namespace collarmesh::brep
