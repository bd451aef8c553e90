#pragma once

#include <array>
#include <cstdint>
#include <string_view>

/// The conventions that the writer and the reader of .msh files share.
namespace collarmesh::io {

constexpr int gmsh_point = 15;

/// A type of elements, and TetMesh's node at each place.
struct GmshType {
  int number;
  std::size_t dimension, nodes;
  std::array<std::uint8_t, 10> order;
};
constexpr std::array<GmshType, 6> gmsh_types{{{1, 1, 2, {0, 1}},
                                              {8, 1, 3, {0, 1, 2}},
                                              {2, 2, 3, {0, 1, 2}},
                                              {9, 2, 6, {0, 1, 2, 3, 4, 5}},
                                              {4, 3, 4, {0, 1, 2, 3}},
                                              {11, 3, 10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}}}};

/// In $Comments: declares that patch i of the complex is surface i + 1 and so on, and region i is volume i.
constexpr std::string_view msh_numbers_are_features = "Entity numbers are those of the complex.";

// Gmsh accepts only positive numbers of physical groups, so a tag that is not from 1 to 2^31 - 1 is
// identified by its group's name alone (label_names.h).

}  // namespace collarmesh::io
