#pragma once

#include <array>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "tolerance/feature_contacts.h"

namespace collarmesh {

/// Returns the width that short edges leave to a tet, divided by the length of its longest edge; 1 if there
/// are no short edges. The width is the length of the shortest short edge. If the short edges are exactly the
/// edges between two groups of corners, the width is at most the distance between the groups: from a corner
/// to the plane of the others, or between two lines. `forces` accepts the short edges, given by their
/// corners; `across` has for each corner, as bits, the corners to which short edges join it.
double narrowness_of(const std::array<Point, 4>& p, const std::array<unsigned, 4>& across);
template <class Forces>
double narrowness_of(const std::array<Point, 4>& p, const Forces& forces) {
  std::array<unsigned, 4> across{};  // by corner: the corners, as bits, to which short edges join it
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j)
      if (forces(i, j)) {
        across[i] |= 1U << j;
        across[j] |= 1U << i;
      }
  return narrowness_of(p, across);
}

/// The edges of a mesh that the input forces to be short: they join features that have no point in common, or
/// places of one patch that face opposite ways. If such features or places are near each other, as on the two
/// sides of a thin wall, at a step or at a strip, no tet there can have both long edges and large angles.
class ForcedEdges {
 public:
  /// The certificate's `least_cosine`: normals up to 26 degrees from opposite count as opposite.
  static constexpr double least_cosine_of_sides = -0.9;

  /// Finds the edges between the current vertices. Keeps a reference to the complex. `features`: by point,
  /// the feature of lowest dimension; other arguments as in a TetMesh. `least_cosine`: two sides of a patch
  /// face opposite ways if the cosine between their normals is below this.
  ForcedEdges(const Plc& plc, std::vector<TetMesh::VertexFeature> features, const std::vector<Point>& points,
              const std::vector<std::array<Index, 3>>& faces, const std::vector<Index>& face_patch,
              double least_cosine);

  /// Returns whether the input forces an edge to be short. False for vertices inserted later, which lie on no
  /// feature.
  bool forces(Index a, Index b) const;
  /// Returns the width that forced edges leave to a tet, relative to its longest edge (narrowness_of).
  double narrowness(const std::array<Point, 4>& p, const std::array<Index, 4>& corners) const;
  /// Returns the lower bound on the dihedral angles of a tet of this narrowness, in degrees: half of the
  /// angle whose tangent is the narrowness. It applies where it is below the bound for tets without forced
  /// edges.
  static double smallest_angle(double narrowness);

 private:
  FeatureContacts contacts_;
  std::vector<TetMesh::VertexFeature> features_;
  std::vector<Vector> normals_;  // by vertex inside a patch: unit normal of the mesh there
  double least_cosine_;
};

}  // namespace collarmesh
