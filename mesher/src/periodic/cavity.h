#pragma once

#include <array>
#include <vector>

#include "remesh/tet_complex.h"

namespace collarmesh::periodicity {

using remeshing::TetComplex;

/// A set of tets that will be replaced by tets with a common apex, an existing or a new vertex. Removed faces
/// of the mesh are replaced, too: by triangles between the rim and the apex, or by given faces, the floor.
struct Cavity {
  struct Side {
    std::array<Index, 3> corners;  ///< positive tet {apex, corners} if the apex is inside the cavity
    Index like;                    ///< the tet whose region the new tet gets
  };
  struct Rim {
    std::array<Index, 2> ends;  ///< first two corners of a new face; the third one is the apex
    Index like;                 ///< the face whose patch the new face gets
  };
  std::vector<Index> tets;
  std::vector<Side> hull;
  std::vector<Index> faces;  ///< faces of the mesh to remove
  std::vector<Rim> rim;
  std::vector<TetComplex::NewFace> floor;
};

/// An editor that changes the tets of a mesh by cavities. Qualities are those of `shape_quality`.
class CavityEditor {
 public:
  /// Tets below this quality have no certain sign in floating point.
  static constexpr double least_quality = 1e-7;

  /// Keeps the mesh by reference; its tets are out of date until `store`.
  explicit CavityEditor(TetMesh& mesh) : mesh_(mesh), complex_(mesh) {}

  const TetMesh& mesh() const { return mesh_; }
  const Point& at(Index vertex) const { return mesh_.points[vertex]; }

  /// Return the cavity of all tets and faces of the mesh at a vertex, edge or face; empty if bodies touch at
  /// every vertex of it (TetComplex::pinched).
  Cavity around_vertex(Index vertex) const;
  Cavity around_edge(Index a, Index b) const;
  Cavity around_face(Index face) const;

  /// Returns the quality of the worst tet if the cavity is filled with this apex; negative if that is below
  /// `least_quality` or the cavity is empty. `vertex` is the apex's number, or none if the apex is new. Sides
  /// that contain the apex do not count.
  double worst(const Cavity& cavity, const Point& apex, Index vertex) const;

  /// Fills the cavity with tets that share the apex.
  void fill(const Cavity& cavity, Index apex);
  /// Fills the cavity with tets at a new vertex, the apex. Returns the vertex.
  Index insert(const Cavity& cavity, const Point& apex, const TetMesh::VertexFeature& feature);
  void move(Index vertex, const Point& to) { complex_.move_vertex(vertex, to); }
  /// Returns the faces that the last filling made: those of the floor, then those at the rim.
  std::span<const Index> created_faces() const { return complex_.created_faces(); }

  void divide_curve_edge(Index before, Index vertex, Index after) {
    complex_.divide_curve_edge(before, vertex, after);
  }
  void join_curve_edges(Index before, Index vertex, Index after) {
    complex_.join_curve_edges(before, vertex, after);
  }
  bool on_curve(Index a, Index b) const { return complex_.on_curve(a, b); }
  void store() { complex_.store(); }

 private:
  template <class IsOf>
  Cavity cavity_of(std::vector<Index> tets, const IsOf& is_of) const;

  TetMesh& mesh_;
  TetComplex complex_;
};

}  // namespace collarmesh::periodicity
