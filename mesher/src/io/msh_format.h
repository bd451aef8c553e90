#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/cell_shapes.h"

/// The conventions that the writer and the reader of .msh files share.
namespace collarmesh::io {

constexpr int gmsh_point = 15;

/// An element type of Gmsh. `places`: our node at each place.
struct GmshType {
  int number;
  CellKind kind;
  int order;
  std::array<std::uint8_t, most_nodes_of_cell> places;

  constexpr std::size_t nodes() const { return shape_of(kind).nodes(order); }
  constexpr std::size_t dimension() const { return shape_of(kind).dimension; }
  constexpr std::span<const std::uint8_t> node_order() const { return {places.data(), nodes()}; }
};
constexpr std::array<GmshType, 12> gmsh_types{
    {{1, CellKind::edge, 1, {0, 1}},
     {8, CellKind::edge, 2, {0, 1, 2}},
     {2, CellKind::triangle, 1, {0, 1, 2}},
     {9, CellKind::triangle, 2, {0, 1, 2, 3, 4, 5}},
     {3, CellKind::quadrangle, 1, {0, 1, 2, 3}},
     {16, CellKind::quadrangle, 2, {0, 1, 2, 3, 4, 5, 6, 7}},
     {4, CellKind::tet, 1, {0, 1, 2, 3}},
     {11, CellKind::tet, 2, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
     {6, CellKind::prism, 1, {0, 1, 2, 3, 4, 5}},
     {18, CellKind::prism, 2, {0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10}},
     {7, CellKind::pyramid, 1, {0, 1, 2, 3, 4}},
     {19, CellKind::pyramid, 2, {0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11, 12}}}};

constexpr const GmshType& gmsh_type(CellKind kind, int order) {
  for (const GmshType& type : gmsh_types)
    if (type.kind == kind && type.order == order) return type;
  return gmsh_types.front();
}

/// A line in $Comments: patch, curve and vertex i of the complex are surface, curve and point i + 1, and
/// region i is volume i.
constexpr std::string_view msh_numbers_are_features = "Entity numbers are those of the complex.";

// Gmsh accepts only positive numbers of physical groups. So a tag that is not from 1 to 2^31 - 2 is
// identified by its group's name alone (label_names.h).

}  // namespace collarmesh::io
