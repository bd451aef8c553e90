#pragma once

#include <med.h>

#include <array>
#include <cstdint>
#include <span>

#include "common/cell_shapes.h"

/// The conventions that the writer and the reader of .med files share.
namespace collarmesh::io {

constexpr const char* med_partition_field = "partition";  // whole numbers on the cells

/// A type of elements, and our node at each place. MED orients cells with volume the other way round. In
/// second order the places of first order come first.
struct MedType {
  CellKind kind;
  std::array<med_geometry_type, 2> types;  ///< by order
  std::array<std::uint8_t, most_nodes_of_cell> places;

  med_geometry_type type(int order) const { return types[order == 2 ? 1 : 0]; }
  constexpr std::span<const std::uint8_t> node_order(int order) const {
    return {places.data(), shape_of(kind).nodes(order)};
  }
};
inline const std::array<MedType, cell_kinds> med_types{
    {{CellKind::tet, {MED_TETRA4, MED_TETRA10}, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
     {CellKind::prism, {MED_PENTA6, MED_PENTA15}, {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13}},
     {CellKind::pyramid, {MED_PYRA5, MED_PYRA13}, {0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10}},
     {CellKind::triangle, {MED_TRIA3, MED_TRIA6}, {0, 1, 2, 3, 4, 5}},
     {CellKind::quadrangle, {MED_QUAD4, MED_QUAD8}, {0, 1, 2, 3, 4, 5, 6, 7}},
     {CellKind::edge, {MED_SEG2, MED_SEG3}, {0, 1, 2}}}};

}  // namespace collarmesh::io
