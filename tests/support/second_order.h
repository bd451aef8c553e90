#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::testing {

/// Returns the mesh with a node in the middle of every edge; each node lies on the features of its edge.
inline TetMesh second_order(TetMesh mesh) {
  std::map<std::pair<Index, Index>, Index> nodes;
  std::map<std::pair<Index, Index>, TetMesh::VertexFeature> features;
  const auto key = [](Index a, Index b) { return std::pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      features[key(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3])] = {2, mesh.face_patch[f]};
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    features[key(mesh.edges[e][0], mesh.edges[e][1])] = {1, mesh.edge_curve[e]};
  const auto middle = [&](Index a, Index b) {
    const auto [found, added] = nodes.try_emplace(key(a, b), static_cast<Index>(mesh.points.size()));
    if (added) {
      if (!mesh.features.empty()) mesh.features.push_back(features[key(a, b)]);
      mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    }
    return found->second;
  };
  LayerCells& layers = mesh.layers;
  for (std::size_t f = 0; f < layers.quads.size(); ++f)
    for (std::size_t k = 0; k < 4; ++k)
      features[key(layers.quads[f][k], layers.quads[f][(k + 1) % 4])] = {2, layers.quad_patch[f]};
  for (const auto& [a, b, c, d] : mesh.tets)
    mesh.tet_mid_nodes.push_back(
        {middle(a, b), middle(b, c), middle(c, a), middle(a, d), middle(b, d), middle(c, d)});
  for (const auto& [a, b, c, d, e, f] : layers.prisms)
    layers.prism_mid_nodes.push_back({middle(a, b), middle(b, c), middle(c, a), middle(d, e), middle(e, f),
                                      middle(f, d), middle(a, d), middle(b, e), middle(c, f)});
  for (const auto& [a, b, c, d, e] : layers.pyramids)
    layers.pyramid_mid_nodes.push_back({middle(a, b), middle(b, c), middle(c, d), middle(d, a), middle(a, e),
                                        middle(b, e), middle(c, e), middle(d, e)});
  for (const auto& [a, b, c, d] : layers.quads)
    layers.quad_mid_nodes.push_back({middle(a, b), middle(b, c), middle(c, d), middle(d, a)});
  for (const auto& [a, b, c] : mesh.faces)
    mesh.face_mid_nodes.push_back({middle(a, b), middle(b, c), middle(c, a)});
  for (const auto& [a, b] : mesh.edges) mesh.edge_mid_nodes.push_back(middle(a, b));
  return mesh;
}

}  // namespace collarmesh::testing
