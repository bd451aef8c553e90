#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::second_order {

/// The edges of a mesh, sorted, each with the feature it lies on: the edges of tets and, in a mesh that
/// misses a guarantee, also edges of faces and curves that belong to no tet. The mid-edge node of edge e is
/// the point first_node() + e.
class MeshEdges {
 public:
  explicit MeshEdges(const TetMesh& mesh);

  std::size_t size() const { return keys_.size(); }
  Index first_node() const { return first_node_; }
  std::array<Index, 2> ends(std::size_t edge) const {
    return {static_cast<Index>(keys_[edge] >> 32U), static_cast<Index>(keys_[edge])};
  }
  const TetMesh::VertexFeature& feature(std::size_t edge) const { return features_[edge]; }
  /// Returns the node of an edge. Precondition: ab is an edge of a tet, a face or a curve. Cost: logarithmic.
  Index node(Index a, Index b) const;

 private:
  std::vector<std::uint64_t> keys_;
  std::vector<TetMesh::VertexFeature> features_;
  Index first_node_;
};

/// Gives each edge of the mesh a node at its middle.
void add_mid_nodes(const MeshEdges& edges, TetMesh& mesh);

}  // namespace collarmesh::second_order
