#pragma once

#include <array>
#include <string_view>

/// What the writer and the reader of .msh files have to agree on.
namespace collarmesh::io {

constexpr int gmsh_line = 1, gmsh_triangle = 2, gmsh_tet = 4, gmsh_point = 15;

/// In $Comments: patch i of the complex is surface i + 1 and so on, region i is volume i.
constexpr std::string_view msh_numbers_are_features = "Entity numbers are those of the complex.";

/// Names of physical groups by dimension: this and the tag. Gmsh takes only positive numbers of
/// physical groups, so a tag that is not from 1 to 2^31 - 1 is known by its name alone.
constexpr std::array<std::string_view, 4> physical_name_prefix{"vertex_", "curve_", "patch_", "region_"};

}  // namespace collarmesh::io
