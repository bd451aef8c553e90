#pragma once

#include <array>
#include <vector>

#include "improve/tet_complex.h"

namespace collarmesh::periodicity {

using improvement::TetComplex;

/// A set of tets to be replaced by tets that all share an apex: a vertex that exists or would be inserted.
/// Removed faces of the mesh are replaced, too: by cones of the same apex, or by a floor of given faces.
struct Cavity {
  struct Side {
    std::array<Index, 3> corners;  ///< make a positive tet behind an apex inside: {apex, corners}
    Index like;                    ///< the tet whose region the new one gets
  };
  struct Rim {
    std::array<Index, 2> ends;  ///< make a face behind the apex
    Index like;                 ///< the face whose patch it gets
  };
  std::vector<Index> tets;
  std::vector<Side> hull;
  std::vector<Index> faces;  ///< faces of the mesh to remove
  std::vector<Rim> rim;
  std::vector<TetComplex::NewFace> floor;
};

/// Changes the tets of a mesh by cavities. Qualities are those of `shape_quality`.
class CavityEditor {
 public:
  /// Tets below this quality have no certain sign in floating point.
  static constexpr double least_quality = 1e-7;

  /// Keeps the mesh by reference; its tets are out of date until `store`.
  explicit CavityEditor(TetMesh& mesh) : mesh_(mesh), complex_(mesh) {}

  const TetMesh& mesh() const { return mesh_; }
  const Point& at(Index vertex) const { return mesh_.points[vertex]; }

  /// Return the tets at a vertex, at an edge or at a face, with cones of all the mesh's faces there; empty
  /// where bodies touch only at the place.
  Cavity around_vertex(Index vertex) const;
  Cavity around_edge(Index a, Index b) const;
  Cavity around_face(Index face) const;

  /// Returns the quality of the worst tet that the cavity has with this apex, negative if it is below the
  /// least one. `vertex` is the apex, none if it is new; sides that contain it do not count.
  double worst(const Cavity& cavity, const Point& apex, Index vertex) const;
  double worst_at(Index vertex) const { return worst(around_vertex(vertex), at(vertex), vertex); }

  /// Fills the cavity with tets that share the apex.
  void fill(const Cavity& cavity, Index apex);
  /// Fills the cavity with a new vertex as the apex, and returns that.
  Index insert(const Cavity& cavity, const Point& apex, const TetMesh::VertexFeature& feature);
  void move(Index vertex, const Point& to) { complex_.move_vertex(vertex, to); }
  /// Returns the faces that the last filling made: the floor, then those on the rim.
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
