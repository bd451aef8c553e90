#pragma once

#include <array>
#include <cstdint>

/// The conventions that the writer and the reader of .unv files share: the Universal File Datasets of SDRC
/// I-DEAS (Structural Dynamics Research Lab, University of Cincinnati: "Universal File Datasets Summary").
namespace collarmesh::io {

constexpr int unv_nodes = 2411, unv_elements = 2412, unv_groups = 2467;
constexpr int unv_group_element = 8;

/// The types of elements with their order of nodes: around the edges, mid-edge nodes in between.
struct UnvType {
  int number;
  std::size_t dimension, nodes;
  std::array<std::uint8_t, 10> order;  ///< TetMesh's node at each place
};
constexpr std::array<UnvType, 12> unv_types{{{111, 3, 4, {0, 1, 2, 3}},
                                             {118, 3, 10, {0, 4, 1, 5, 2, 6, 7, 8, 9, 3}},
                                             {91, 2, 3, {0, 1, 2}},
                                             {92, 2, 6, {0, 3, 1, 4, 2, 5}},
                                             {41, 2, 3, {0, 1, 2}},
                                             {42, 2, 6, {0, 3, 1, 4, 2, 5}},
                                             {51, 2, 3, {0, 1, 2}},
                                             {52, 2, 6, {0, 3, 1, 4, 2, 5}},
                                             {21, 1, 2, {0, 1}},
                                             {24, 1, 3, {0, 2, 1}},
                                             {11, 1, 2, {0, 1}},
                                             {22, 1, 3, {0, 2, 1}}}};
constexpr int unv_rod = 11;
/// Returns whether elements of this type have an additional record, as beams do.
constexpr bool unv_is_beam(int type) { return type == 21 || type == 22 || type == 24; }

}  // namespace collarmesh::io
