#pragma once

#include <string>

#include "topology.h"

namespace collarmesh::brep {

/// Sews the faces of a shape without solids within 1e-5, then 1e-4 and 1e-3 of the diagonal, until no edge is
/// open; if some edges always stay open, keeps the result with the fewest, and of equal ones that of the
/// smallest gap. Closed shells become solids, nearly closed ones open solids; notes tell how many faces of
/// other shells are left out. If no shell is closed, all faces become one open solid.
void sew_faces(const std::string& file, Topology& topology);

/// Sews the faces of open solids within the same gaps. Solids that stay open are kept, and described in
/// `open_text`.
void close_solids(const std::string& file, Topology& topology);

}  // namespace collarmesh::brep
