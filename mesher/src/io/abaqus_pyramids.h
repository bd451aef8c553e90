#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"
#include "io/file_writer.h"

/// Pyramids of second order in .inp files. Neither CalculiX nor Abaqus has them, and hexahedra of second
/// order with equal nodes would not fit the triangles of tets. Each pyramid is two tets, C3D10, with a node
/// amid its base, which follows the eight nodes there as the middle of a prism's side does. Linear
/// displacements and temperatures are exact then if the base is a parallelogram, and nearly so if it almost
/// is one.
namespace collarmesh::io {

/// The set that has the halves of pyramids, one after the other, in lower case.
constexpr const char* abaqus_halves = "halves_of_pyramids";

/// The two tets of each pyramid of a mesh of second order; of others nothing.
class HalvedPyramids {
 public:
  explicit HalvedPyramids(const TetMesh& mesh);

  bool any() const { return !middle_.empty(); }
  /// The nodes amid bases, which follow the mesh's points.
  const std::vector<Point>& nodes() const { return nodes_; }
  /// The nodes of the first (0) or second (1) half.
  CellNodes half(Index pyramid, std::size_t half) const;

  struct Side {
    std::size_t half;
    unsigned number;  ///< 1: S1
  };
  /// The sides of halves that make up a side of the pyramid: two for the base.
  std::vector<Side> sides(Index pyramid, std::size_t side) const;

  /// Writes how the nodes amid bases follow the others, in displacements and temperatures.
  void write_equations(FileWriter& out) const;

 private:
  std::size_t first_corner(Index pyramid) const;
  CellNodes turned(Index pyramid) const;

  const TetMesh& mesh_;
  std::vector<Point> nodes_;
  std::vector<Index> middle_;                ///< by pyramid
  std::vector<std::array<Index, 8>> bases_;  ///< by node: corners, then mid-edge nodes
};

/// Joins the halves of pyramids that were read, pairs of tets, and removes the nodes amid their bases if no
/// other points follow them. Returns the new index of each tet, none for halves; nothing if they are no
/// halves.
std::optional<std::vector<Index>> join_pyramids(const std::vector<std::array<Index, 2>>& halves,
                                                TetMesh& mesh);

/// Returns the side of a joined pyramid that a side of a half is; nothing for a base's second part.
std::optional<std::size_t> side_of_pyramid(std::size_t half, unsigned number);

}  // namespace collarmesh::io
