#pragma once

#include <array>
#include <vector>

#include "improve/tet_complex.h"

namespace collarmesh::periodicity {

using improvement::TetComplex;

/// Tets that others can take the place of, all of which share an apex: a vertex that is there or would be.
/// Where the mesh's faces go, others take their place: cones of the same apex, or a floor of given ones.
struct Cavity {
  struct Side {
    std::array<Index, 3> corners;  ///< make a positive tet behind an apex inside: {apex, corners}
    Index like;                    ///< the tet whose region the new one takes
  };
  struct Rim {
    std::array<Index, 2> ends;  ///< make a face behind the apex
    Index like;                 ///< the face whose patch it takes
  };
  std::vector<Index> tets;
  std::vector<Side> hull;
  std::vector<Index> faces;  ///< that go
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

  /// The tets at a vertex, at an edge or at a face, with cones of all the mesh's faces there; empty where
  /// bodies touch at the place only.
  Cavity around_vertex(Index vertex) const;
  Cavity around_edge(Index a, Index b) const;
  Cavity around_face(Index face) const;

  /// Returns the quality of the worst tet that the cavity has with this apex, negative if it is below the
  /// least one. `vertex`: the apex, none if it is new; sides that contain it count for nothing.
  double worst(const Cavity& cavity, const Point& apex, Index vertex) const;
  double worst_at(Index vertex) const { return worst(around_vertex(vertex), at(vertex), vertex); }

  /// Fills the cavity.
  void fill(const Cavity& cavity, Index apex);
  /// Fills it with a new vertex as the apex, and returns that.
  Index insert(const Cavity& cavity, const Point& apex, const TetMesh::VertexFeature& feature);
  void move(Index vertex, const Point& to) { complex_.move_vertex(vertex, to); }
  /// The faces that the last filling made: the floor, then those on the rim.
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
