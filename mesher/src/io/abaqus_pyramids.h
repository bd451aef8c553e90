#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"
#include "io/file_writer.h"

/// Pyramids of second order in .inp files. Neither CalculiX nor Abaqus has them, and hexahedra of second
/// order with coinciding nodes would not conform to the triangles of tets. Each pyramid becomes two tets,
/// C3D10, with a node in the middle of its base. The values at this node are interpolated from the base's
/// eight nodes, as in the middle of a prism's side. A solution that is linear in space is then exact if the
/// base is a parallelogram, and nearly exact if the base almost is one.
namespace collarmesh::io {

/// The name, in lower case, of the set of the halves of pyramids. The two halves of a pyramid follow each
/// other in it.
constexpr const char* abaqus_halves = "halves_of_pyramids";

/// The two tets of each pyramid of a mesh of second order; empty for first order.
class HalvedPyramids {
 public:
  explicit HalvedPyramids(const TetMesh& mesh);

  bool any() const { return !middle_.empty(); }
  /// Returns the nodes in the middle of bases; they are numbered after the mesh's points.
  const std::vector<Point>& nodes() const { return nodes_; }
  /// Returns the nodes of the first (0) or second (1) half.
  CellNodes half(Index pyramid, std::size_t half) const;

  struct Side {
    std::size_t half;
    unsigned number;  ///< 1: S1
  };
  /// Returns the sides of halves that make up a side of the pyramid: two for its base, one for any other
  /// side.
  std::vector<Side> sides(Index pyramid, std::size_t side) const;

  /// Writes the equations for the nodes in the middle of bases: their displacements and temperatures follow
  /// from the other nodes.
  void write_equations(FileWriter& out) const;

 private:
  std::size_t first_corner(Index pyramid) const;
  CellNodes turned(Index pyramid) const;

  const TetMesh& mesh_;
  std::vector<Point> nodes_;
  std::vector<Index> middle_;                ///< by pyramid
  std::vector<std::array<Index, 8>> bases_;  ///< by node: corners, then mid-edge nodes
};

/// Joins pairs of tets that are halves of pyramids, and removes the nodes in the middle of their bases if
/// these are the last points. Returns the new index of each tet, none for halves. Returns nothing if a pair
/// does not form a pyramid.
std::optional<std::vector<Index>> join_pyramids(const std::vector<std::array<Index, 2>>& halves,
                                                TetMesh& mesh);

/// Returns the side of the pyramid to which side `number` (1: S1) of a half belongs; nothing for the side
/// between the halves and for the second half's part of the base.
std::optional<std::size_t> side_of_pyramid(std::size_t half, unsigned number);

}  // namespace collarmesh::io
