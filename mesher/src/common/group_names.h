#pragma once

#include <array>
#include <string>
#include <string_view>

#include "collarmesh/geometry.h"
#include "collarmesh/tet_mesh.h"

/// Names of groups of cells: a given name, or a prefix by dimension and the tag.
namespace collarmesh {

constexpr std::array<std::string_view, 4> group_name_prefix{"vertex_", "curve_", "patch_", "region_"};
constexpr std::array<std::string_view, 4> cad_name_prefix{"Vertex", "Edge", "Face", "Solid"};

/// Returns "patch_7" or "Face7" for the tag 7. For -7, writes `minus` in place of the hyphen, which some
/// formats do not allow in names: "patch_minus_7".
std::string group_name(GroupNames names, std::size_t dimension, Tag tag, std::string_view minus = "minus_");

/// Returns the name that the tag was given, with `_` for quotes and control characters; without such a name,
/// the one made of dimension and tag.
std::string group_name(const TetMesh& mesh, std::size_t dimension, Tag tag,
                       std::string_view minus = "minus_");

}  // namespace collarmesh
