#pragma once

#include <array>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "layers/front.h"
#include "layers/heights.h"

namespace collarmesh::layering {

/// The mesh of the core before anything moves: the mesh with a copy, at the same place, of each node of the
/// front that will move. The faces of walls become faces of the front.
class CoreMesh {
 public:
  CoreMesh(const TetMesh& given, const Front& front, const Heights& heights);

  TetMesh mesh;
  std::vector<Index> vertex_of;  ///< by node of the front: its copy, or the node itself if it does not move
  std::vector<Index> node_of;    ///< by vertex: the node of the front whose copy it is, or none

 private:
  /// A face of the front, or a face of a wall on a side that does not move.
  struct NewFace {
    std::array<Index, 3> corners;
    Index region;
    Index like;  // the wall's face, whose patch and tag it has
  };

  void copy_nodes();
  void copy_corners_of_other_faces();
  void replace_walls();
  void copy_ends_of_edges();
  void drop_edges_of_walls();
  bool moves(const WallSide& side) const;

  const TetMesh& given_;
  const Front& front_;
  const Heights& heights_;
};

}  // namespace collarmesh::layering
