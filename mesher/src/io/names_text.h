#pragma once

#include <string>
#include <string_view>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// The names of a mesh's groups as text, for formats that have a place for text but none for names: a line
/// for each, as "patch 7 inlet", and the line "cad" where the others are called as in a CAD shape. Empty
/// where there are none.
std::string names_text(const TetMesh& mesh);

/// Give a mesh the names of such a text. Other lines are left out.
void take_names(std::string_view text, TetMesh& mesh);

}  // namespace collarmesh::io
