#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/cell_shapes.h"

/// The conventions that the writer and the reader of .inp files share; Abaqus Keywords Reference Manual.
namespace collarmesh::io {

/// The numbers of the faces of Abaqus' elements (3 for S3), in the order of our cells' sides. A pyramid is
/// written as a hexahedron whose last four corners are one node, because CalculiX has no pyramids.
constexpr std::array<unsigned, 4> abaqus_tet_faces{3, 4, 2, 1};
constexpr std::array<unsigned, 5> abaqus_prism_faces{1, 2, 3, 4, 5};
constexpr std::array<unsigned, 5> abaqus_pyramid_faces{1, 3, 4, 5, 6};
constexpr std::span<const unsigned> abaqus_faces(CellKind kind) {
  if (kind == CellKind::prism) return abaqus_prism_faces;
  if (kind == CellKind::pyramid) return abaqus_pyramid_faces;
  return abaqus_tet_faces;
}
constexpr std::array<std::uint8_t, 8> abaqus_pyramid_order{0, 1, 2, 3, 4, 4, 4, 4};

/// Prefix of the name of our element set for a region of the complex; the region's number follows.
constexpr const char* abaqus_volume_prefix = "VOLUME_";

/// The name of the set of all elements, in lower case.
constexpr const char* abaqus_everything = "eall";

}  // namespace collarmesh::io
