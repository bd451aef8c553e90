#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "support/plc_shapes.h"

/// Maps of periodic faces for meshes that no mesher made, by brute force.
namespace collarmesh::testing {

/// Returns the unit cube, divided into 27 boxes at these places along each axis. In the periodic pattern the
/// cube's faces, edges and corners cut larger boxes into these.
inline PolygonSoup cell_of_boxes(const std::array<double, 4>& cuts) {
  std::vector<PolygonSoup> boxes;
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j)
      for (unsigned k = 0; k < 3; ++k)
        boxes.push_back(polygonal_box({cuts[i], cuts[j], cuts[k]}, {cuts[i + 1], cuts[j + 1], cuts[k + 1]}));
  return joined(boxes);
}

inline TetMesh::Motion translation(const Vector& shift) {
  TetMesh::Motion motion;
  motion.shift = shift;
  return motion;
}

/// Returns a rotation about the z axis by a right angle.
inline TetMesh::Motion quarter_turn() {
  TetMesh::Motion motion;
  motion.rows = {Vector{0, -1, 0}, Vector{1, 0, 0}, Vector{0, 0, 1}};
  return motion;
}

inline std::set<Index> nodes_with_tags(const TetMesh& mesh, const std::vector<Tag>& tags) {
  std::set<Index> nodes;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (std::find(tags.begin(), tags.end(), mesh.face_tag[f]) == tags.end()) continue;
    nodes.insert(mesh.faces[f].begin(), mesh.faces[f].end());
    if (mesh.order() == 2) nodes.insert(mesh.face_mid_nodes[f].begin(), mesh.face_mid_nodes[f].end());
  }
  return nodes;
}

/// Maps each node of the first group onto the node of the second group that is nearest to its image.
inline TetMesh::PeriodicFaces mapped_faces(const TetMesh& mesh, std::vector<Tag> first,
                                           std::vector<Tag> second, const TetMesh::Motion& motion) {
  TetMesh::PeriodicFaces faces{std::move(first), std::move(second), motion, {}};
  const std::set<Index> images = nodes_with_tags(mesh, faces.second);
  for (const Index node : nodes_with_tags(mesh, faces.first)) {
    const Point image = motion(mesh.points[node]);
    const auto nearest = std::min_element(images.begin(), images.end(), [&](Index a, Index b) {
      return squared_distance(mesh.points[a], image) < squared_distance(mesh.points[b], image);
    });
    faces.nodes.push_back({node, *nearest});
  }
  return faces;
}

/// Makes all three pairs of sides of a box periodic, with the tags 1 to 6 (x, y, z, low and high).
inline void make_box_periodic(TetMesh& mesh, const Vector& size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector shift{0, 0, 0};
    shift[axis] = size[axis];
    const Tag low = static_cast<Tag>(2 * axis + 1);
    mesh.periodic.push_back(mapped_faces(mesh, {low}, {low + 1}, translation(shift)));
  }
}

}  // namespace collarmesh::testing
