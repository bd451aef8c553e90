#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// The nodes of a cell of either order: its corners, then its mid-edge nodes in the order of TetMesh (ab, bc,
/// ca, ad, bd, cd). VTK, Abaqus and Medit number them in the same way.
class CellNodes {
 public:
  template <std::size_t corners, std::size_t mid_nodes>
  static CellNodes of(const std::array<Index, corners>& cell,
                      const std::vector<std::array<Index, mid_nodes>>& middle, std::size_t i) {
    CellNodes result;
    for (const Index v : cell) result.add(v);
    if (!middle.empty())
      for (const Index v : middle[i]) result.add(v);
    return result;
  }

  void add(Index node) { nodes_[count_++] = node; }
  /// Returns a cell whose k-th node is this one's node order[k]; unchanged in first order.
  CellNodes in_order(std::span<const std::uint8_t> order) const {
    if (order.size() != count_) return *this;
    CellNodes result;
    for (const std::uint8_t k : order) result.add(nodes_[k]);
    return result;
  }

  std::size_t size() const { return count_; }
  const Index* begin() const { return nodes_.data(); }
  const Index* end() const { return nodes_.data() + count_; }
  Index operator[](std::size_t k) const { return nodes_[k]; }

 private:
  std::array<Index, 10> nodes_{};
  std::size_t count_ = 0;
};

inline CellNodes nodes_of_tet(const TetMesh& mesh, std::size_t i) {
  return CellNodes::of(mesh.tets[i], mesh.tet_mid_nodes, i);
}
inline CellNodes nodes_of_face(const TetMesh& mesh, std::size_t i) {
  return CellNodes::of(mesh.faces[i], mesh.face_mid_nodes, i);
}
inline CellNodes nodes_of_edge(const TetMesh& mesh, std::size_t i) {
  CellNodes result;
  for (const Index v : mesh.edges[i]) result.add(v);
  if (mesh.order() == 2) result.add(mesh.edge_mid_nodes[i]);
  return result;
}

/// Adds a cell of either order to a mesh that is being read.
inline void add_tet(const CellNodes& n, TetMesh& mesh) {
  mesh.tets.push_back({n[0], n[1], n[2], n[3]});
  if (n.size() == 10) mesh.tet_mid_nodes.push_back({n[4], n[5], n[6], n[7], n[8], n[9]});
}
inline void add_face(const CellNodes& n, TetMesh& mesh) {
  mesh.faces.push_back({n[0], n[1], n[2]});
  if (n.size() == 6) mesh.face_mid_nodes.push_back({n[3], n[4], n[5]});
}
inline void add_edge(const CellNodes& n, TetMesh& mesh) {
  mesh.edges.push_back({n[0], n[1]});
  if (n.size() == 3) mesh.edge_mid_nodes.push_back(n[2]);
}

}  // namespace collarmesh::io
