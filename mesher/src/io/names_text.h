#pragma once

#include <string>
#include <string_view>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Returns the names of a mesh's groups as text, for formats that can store text but not names: a line for
/// each, as "patch 7 inlet", and the line "cad" if groups without a given name are called as in a CAD shape
/// ("Face7"). Empty if there are no names.
std::string names_text(const TetMesh& mesh);

/// Gives a mesh the names in a text made by `names_text`. Ignores other lines.
void take_names(std::string_view text, TetMesh& mesh);

}  // namespace collarmesh::io
