#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Sews the faces of a shape without solids within 1e-5, then 1e-4 and 1e-3 of the diagonal, until no edge is
/// open; if some stay open, takes the smallest gap that leaves the fewest. Closed shells become solids,
/// nearly closed ones open solids. If no shell is closed, all faces become one open solid.
void sew_faces(const std::string& file, Topology& topology);

/// Sews the faces of open solids in the same way. Solids that stay open are kept, and described in
/// `open_text`.
void close_solids(const std::string& file, Topology& topology);

}  // namespace collarmesh::brep
