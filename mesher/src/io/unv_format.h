#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/cell_shapes.h"

/// The conventions that the writer and the reader of .unv files share: the Universal File Datasets of SDRC
/// I-DEAS (Structural Dynamics Research Lab, University of Cincinnati: "Universal File Datasets Summary").
namespace collarmesh::io {

constexpr int unv_nodes = 2411, unv_elements = 2412, unv_groups = 2467;
constexpr int unv_group_element = 8;

/// A type of elements and the order of its nodes: corners and mid-edge nodes in turn around the first face;
/// then the mid-edge nodes of the edges that rise from it; then the opposite face, like the first, or the
/// opposite corner. The format has no pyramids: they are written as bricks whose upper nodes are all the
/// apex.
struct UnvType {
  int number;
  CellKind kind;
  int order;
  std::size_t nodes;
  std::array<std::uint8_t, 20> places;  ///< our node at each place

  constexpr std::span<const std::uint8_t> node_order() const { return {places.data(), nodes}; }
};
/// The first type of a kind and order is the one that is written.
constexpr std::array<UnvType, 22> unv_types{
    {{111, CellKind::tet, 1, 4, {0, 1, 2, 3}},
     {118, CellKind::tet, 2, 10, {0, 4, 1, 5, 2, 6, 7, 8, 9, 3}},
     {112, CellKind::prism, 1, 6, {0, 1, 2, 3, 4, 5}},
     {113, CellKind::prism, 2, 15, {0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11}},
     {115, CellKind::pyramid, 1, 8, {0, 1, 2, 3, 4, 4, 4, 4}},
     {116, CellKind::pyramid, 2, 20, {0, 5, 1, 6, 2, 7, 3, 8, 9, 10, 11, 12, 4, 4, 4, 4, 4, 4, 4, 4}},
     {91, CellKind::triangle, 1, 3, {0, 1, 2}},
     {92, CellKind::triangle, 2, 6, {0, 3, 1, 4, 2, 5}},
     {41, CellKind::triangle, 1, 3, {0, 1, 2}},
     {42, CellKind::triangle, 2, 6, {0, 3, 1, 4, 2, 5}},
     {51, CellKind::triangle, 1, 3, {0, 1, 2}},
     {52, CellKind::triangle, 2, 6, {0, 3, 1, 4, 2, 5}},
     {94, CellKind::quadrangle, 1, 4, {0, 1, 2, 3}},
     {95, CellKind::quadrangle, 2, 8, {0, 4, 1, 5, 2, 6, 3, 7}},
     {44, CellKind::quadrangle, 1, 4, {0, 1, 2, 3}},
     {45, CellKind::quadrangle, 2, 8, {0, 4, 1, 5, 2, 6, 3, 7}},
     {54, CellKind::quadrangle, 1, 4, {0, 1, 2, 3}},
     {55, CellKind::quadrangle, 2, 8, {0, 4, 1, 5, 2, 6, 3, 7}},
     {21, CellKind::edge, 1, 2, {0, 1}},
     {24, CellKind::edge, 2, 3, {0, 2, 1}},
     {11, CellKind::edge, 1, 2, {0, 1}},
     {22, CellKind::edge, 2, 3, {0, 2, 1}}}};
constexpr int unv_rod = 11;
/// Returns whether elements of this type have an additional record, as beams do.
constexpr bool unv_is_beam(int type) { return type == 21 || type == 22 || type == 24; }

}  // namespace collarmesh::io
