#include "layers/core_mesh.h"

#include <algorithm>
#include <cstdint>

namespace collarmesh::layering {

CoreMesh::CoreMesh(const TetMesh& given, const Front& front, const Heights& heights)
    : mesh(given), given_(given), front_(front), heights_(heights) {
  mesh.collar_balls.clear();
  mesh.layers = {};
  copy_nodes();
  copy_corners_of_other_faces();
  replace_walls();
  copy_ends_of_edges();
  drop_edges_of_walls();
}

/// Gives each moving node of the front a copy, which replaces it in the tets of its sector.
void CoreMesh::copy_nodes() {
  node_of.assign(mesh.points.size(), none);
  for (Index n = 0; n < front_.nodes.size(); ++n) {
    const Index vertex = front_.nodes[n].vertex;
    if (heights_[n] == 0) {
      vertex_of.push_back(vertex);
      continue;
    }
    vertex_of.push_back(static_cast<Index>(mesh.points.size()));
    node_of.push_back(n);
    mesh.points.push_back(given_.points[vertex]);
    mesh.features.push_back(given_.features[vertex]);
  }
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const Index n = front_.node_of(t, corner); n != none) mesh.tets[t][corner] = vertex_of[n];
}

/// Replaces moving nodes by their copies in faces without layers.
void CoreMesh::copy_corners_of_other_faces() {
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index face = front_.tet(t).faces[corner];
      if (face == none || front_.is_wall(face)) continue;
      for (Index& v : mesh.faces[face])
        for (unsigned i = 0; i < 4; ++i)
          if (i != corner && given_.tets[t][i] == v) {
            v = mesh.tets[t][i];
            break;
          }
    }
}

bool CoreMesh::moves(const WallSide& side) const {
  return std::any_of(side.nodes.begin(), side.nodes.end(), [&](Index n) { return heights_[n] > 0; });
}

/// Turns the moving faces of walls into faces of the front. If an interface moves on one side only, adds
/// faces with the wall's own nodes for the other side.
void CoreMesh::replace_walls() {
  std::vector<std::uint8_t> replaced(mesh.faces.size(), 0);
  std::vector<NewFace> faces;
  for (const WallSide& side : front_.sides) {
    if (!moves(side)) continue;
    const auto& [a, b, c] = side.nodes;
    replaced[side.face] = 1;
    faces.push_back({{vertex_of[a], vertex_of[c], vertex_of[b]}, side.region, side.face});
  }
  const auto keep_side = [&](const WallSide& side) {
    const auto& [a, b, c] = side.corners;
    if (replaced[side.face] != 0) faces.push_back({{a, c, b}, side.region, side.face});
  };
  for (const WallSide& side : front_.sides)
    if (!moves(side)) keep_side(side);
  for (const WallSide& side : front_.bare_sides) keep_side(side);
  const auto keep_others = [&replaced](auto& list) {
    std::size_t kept = 0;
    for (std::size_t f = 0; f < list.size(); ++f)
      if (replaced[f] == 0) list[kept++] = list[f];
    list.resize(kept);
  };
  keep_others(mesh.faces), keep_others(mesh.face_regions);
  keep_others(mesh.face_patch), keep_others(mesh.face_tag);
  for (const NewFace& face : faces) {
    mesh.faces.push_back(face.corners);
    mesh.face_regions.push_back({face.region, 0});
    mesh.face_patch.push_back(given_.face_patch[face.like]);
    mesh.face_tag.push_back(given_.face_tag[face.like]);
  }
}

/// Replaces moving nodes by their copies in edges of curves that lead away from walls.
void CoreMesh::copy_ends_of_edges() {
  for (Index n = 0; n < front_.nodes.size(); ++n)
    for (const Index e : front_.edges_of[n])
      for (Index& v : mesh.edges[e])
        if (v == front_.nodes[n].vertex) v = vertex_of[n];
}

void CoreMesh::drop_edges_of_walls() {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = given_.edges[e];
    if (front_.is_wall_edge(a, b)) continue;
    mesh.edges[kept] = mesh.edges[e];
    mesh.edge_curve[kept] = mesh.edge_curve[e];
    mesh.edge_tag[kept] = mesh.edge_tag[e];
    ++kept;
  }
  mesh.edges.resize(kept), mesh.edge_curve.resize(kept), mesh.edge_tag.resize(kept);
}

}  // namespace collarmesh::layering
