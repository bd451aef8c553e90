#include "second_order/mid_nodes.h"

#include <algorithm>
#include <cassert>

#include "common/edge_key.h"
#include "common/sort_uniquely.h"

namespace collarmesh::second_order {

MeshEdges::MeshEdges(const TetMesh& mesh) : first_node_(static_cast<Index>(mesh.points.size())) {
  keys_.reserve(6 * mesh.tets.size() + 3 * mesh.faces.size() + mesh.edges.size());
  for (const auto& [a, b, c, d] : mesh.tets)
    for (const std::uint64_t each :
         {edge_key(a, b), edge_key(b, c), edge_key(c, a), edge_key(a, d), edge_key(b, d), edge_key(c, d)})
      keys_.push_back(each);
  for (const auto& [a, b, c] : mesh.faces)
    for (const std::uint64_t each : {edge_key(a, b), edge_key(b, c), edge_key(c, a)}) keys_.push_back(each);
  for (const auto& [a, b] : mesh.edges) keys_.push_back(edge_key(a, b));
  sort_uniquely(keys_);
  keys_.shrink_to_fit();
  features_.resize(keys_.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      features_[node(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]) - first_node_] = {2, mesh.face_patch[f]};
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    features_[node(mesh.edges[e][0], mesh.edges[e][1]) - first_node_] = {1, mesh.edge_curve[e]};
}

Index MeshEdges::node(Index a, Index b) const {
  const auto found = std::ranges::lower_bound(keys_, edge_key(a, b));
  assert(found != keys_.end() && *found == edge_key(a, b));
  return first_node_ + static_cast<Index>(found - keys_.begin());
}

void add_mid_nodes(const MeshEdges& edges, TetMesh& mesh) {
  mesh.points.reserve(mesh.points.size() + edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges.ends(e);
    mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    if (!mesh.features.empty()) mesh.features.push_back(edges.feature(e));
  }
  mesh.tet_mid_nodes.reserve(mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets)
    mesh.tet_mid_nodes.push_back({edges.node(a, b), edges.node(b, c), edges.node(c, a), edges.node(a, d),
                                  edges.node(b, d), edges.node(c, d)});
  mesh.face_mid_nodes.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces)
    mesh.face_mid_nodes.push_back({edges.node(a, b), edges.node(b, c), edges.node(c, a)});
  mesh.edge_mid_nodes.reserve(mesh.edges.size());
  for (const auto& [a, b] : mesh.edges) mesh.edge_mid_nodes.push_back(edges.node(a, b));
}

}  // namespace collarmesh::second_order
