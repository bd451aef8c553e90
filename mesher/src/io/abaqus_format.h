#pragma once

#include <array>
#include <cstdint>

/// The conventions that the writer and the reader of .inp files share; Abaqus Keywords Reference Manual.
namespace collarmesh::io {

/// The corners of the faces S1 to S4 of C3D4 and C3D10, and their mid-edge nodes.
constexpr std::array<std::array<std::uint8_t, 3>, 4> abaqus_faces{
    {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
constexpr std::array<std::array<std::uint8_t, 3>, 4> abaqus_face_mid_nodes{
    {{0, 1, 2}, {3, 4, 0}, {4, 5, 1}, {5, 3, 2}}};
/// The numbers of these faces, by the opposite corner.
constexpr std::array<unsigned, 4> abaqus_face_opposite{3, 4, 2, 1};

/// Prefix of our element sets by region of the complex; the region's number follows.
constexpr const char* abaqus_volume_prefix = "VOLUME_";

/// The set of all elements, in lower case.
constexpr const char* abaqus_everything = "eall";

}  // namespace collarmesh::io
