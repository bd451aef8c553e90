#pragma once

#include <cstdint>

namespace collarmesh::io {

constexpr std::uint8_t vtk_vertex = 1, vtk_line = 3, vtk_triangle = 5, vtk_tet = 10;

}  // namespace collarmesh::io
