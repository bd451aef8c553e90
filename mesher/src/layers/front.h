#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/cells_at_vertices.h"
#include "layers/wall_choice.h"
#include "remesh/tet_complex.h"

namespace collarmesh::layering {

/// Groups of numbers, stored one after the other.
struct Lists {
  std::vector<Index> first{0};  // the first entry of each group, then the number of all entries
  std::vector<Index> entries;

  std::size_t size() const { return first.size() - 1; }
  std::span<const Index> operator[](std::size_t i) const {
    return std::span(entries).subspan(first[i], first[i + 1] - first[i]);
  }
  void end_group() { first.push_back(static_cast<Index>(entries.size())); }
};

/// Returns the nodes at most `rings` steps away from one of `nodes`, sorted. `neighbours`: by node.
std::vector<Index> within_rings(const Lists& neighbours, std::vector<Index> nodes, unsigned rings);

/// A side of a wall's triangle that gets layers.
struct WallSide {
  Index face = none;             ///< triangle of the mesh
  Index tet = none;              ///< tet on this side
  std::array<Index, 3> corners;  ///< counterclockwise for a viewer in `tet`
  std::array<Index, 3> nodes;    ///< the front's nodes at these corners
  Index patch = none, region = none;

  /// The continuation of the layers across the edge from corner i to corner i + 1: at another side, at a face
  /// without layers, or none.
  struct Edge {
    Index beyond = none;  ///< the other side; none: there is a face without layers, or nothing
    /// The face without layers at which the layers end, or which separates layers in two regions; none: no
    /// such face.
    Index across = none;
    bool outwards = false;  ///< `across` is oriented away from the tets on this side
    bool blocked = false;   ///< no layers are possible
  };
  std::array<Edge, 3> edges;
};

/// A node of the mesh in one sector of the tets around it. Sectors lie between walls.
struct FrontNode {
  Index vertex = none;
  Vector direction{};  ///< unit; into the sector
  /// The mean cosine between the direction and the normals of a patch's sides, weighted by angles, for the
  /// patch where it is least.
  double cosine = 0;
  double least_cosine = 0;  ///< the least cosine between the direction and the normal of a side
  bool blocked = false;     ///< there can be no layer
  /// The feature without layers along which the node slides.
  TetMesh::VertexFeature slides_on = {};
};

/// The front that layers push inwards: its nodes and triangles, as they are at the wall.
class Front {
 public:
  /// Keeps references to all arguments. `complex` is that of the mesh.
  Front(const remeshing::TetComplex& complex, const Plc& plc, const WallChoice& walls);

  std::vector<WallSide> sides;
  /// Sides of walls whose triangles get layers only on the other side; they have no nodes and no edges.
  std::vector<WallSide> bare_sides;
  std::vector<FrontNode> nodes;
  Lists sides_at;              ///< by node: sides with it
  Lists neighbours;            ///< by node: the other nodes of its sides
  Lists edges_of;              ///< by node: edges of curves in its sector that are not edges of walls
  std::vector<bool> on_wall;   ///< by vertex of the mesh: whether it is a corner of a wall's triangle
  std::vector<Index> node_at;  ///< four per tet: the front's node at each corner, or none

  /// Returns the front's node at a corner of a tet.
  Index node_of(Index tet, unsigned corner) const { return node_at[4 * std::size_t{tet} + corner]; }
  /// Returns the unit normal of a side, pointing inwards.
  Vector normal(const WallSide& side) const;
  /// Returns whether a face of the mesh is a wall's triangle.
  bool is_wall(Index face) const { return face != none && walls_.is_wall(mesh_.face_patch[face]); }
  bool is_wall_patch(Index patch) const { return walls_.is_wall(patch); }
  const remeshing::TetComplex::Tet& tet(Index t) const { return complex_[t]; }
  /// Returns whether an edge of the mesh is an edge of a wall's triangle.
  bool is_wall_edge(Index a, Index b) const;

 private:
  void find_sides();
  void add_side(Index tet, unsigned corner);
  bool is_bare(Index tet, unsigned corner) const;
  void find_nodes();
  void find_sector(Index vertex, Index tet, std::vector<Index>& sector);
  void number_corners();
  void link_edges();
  WallSide::Edge follow(const WallSide& side, unsigned corner) const;
  void list_sides();
  void find_directions();
  void find_direction(Index node, std::span<const Index> sector_faces, std::span<const Index> sector_edges);
  /// The mean of unit normals of sides of one patch at a node, weighted by their angles there.
  struct PatchNormal {
    Index patch;
    double angle;
    Vector mean;
  };
  std::vector<PatchNormal> normals_of_patches(Index node) const;

  const remeshing::TetComplex& complex_;
  const TetMesh& mesh_;
  const Plc& plc_;
  const WallChoice& walls_;
  CellsAtVertices edges_at_;
  std::vector<std::uint64_t> wall_edges_;  // keys, sorted
  std::vector<Index> side_of_;  // four per tet: index of the wall's side opposite each corner, or none
  Lists faces_at_;              // by node: faces without layers in its sector
};

}  // namespace collarmesh::layering
