#pragma once

#include <array>
#include <cstdint>
#include <string>

/// The conventions that the writer and the reader of TetGen's meshes share (TetGen 1.5's manual, "File
/// formats"): NAME.node, NAME.ele, NAME.face and NAME.edge belong together.
namespace collarmesh::io {

/// TetMesh's node at each place of a cell of second order, as TetGen 1.5.0 writes it with -o2.
constexpr std::array<std::uint8_t, 10> tetgen_tet_order{0, 1, 2, 3, 9, 7, 4, 5, 8, 6};
constexpr std::array<std::uint8_t, 6> tetgen_face_order{0, 1, 2, 4, 5, 3};

/// Returns the file beside `path` with this extension.
std::string tetgen_sibling(const std::string& path, const char* extension);

}  // namespace collarmesh::io
