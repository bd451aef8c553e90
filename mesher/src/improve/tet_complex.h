#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/edge_key.h"
#include "common/known_neighbours.h"
#include "common/large_pages.h"
#include "common/tet_sides.h"
#include "improve/undo_log.h"

namespace collarmesh::improvement {

/// The mesh's tets with adjacency, ready for local operations, linked to the faces that must be preserved:
/// boundaries, interfaces and facets inside regions.
class TetComplex {
 public:
  struct Tet {
    std::array<Index, 4> corners;
    std::array<Index, 4> neighbours;  ///< across the face opposite each corner; none at a boundary
    std::array<Index, 4> faces;       ///< index of that face among the mesh's faces; none if it is no mesh
                                      ///< face
    Index region;
    std::uint32_t generation;
    bool alive, collar;
  };
  struct NewTet {
    std::array<Index, 4> corners;
    Index like;  ///< a tet of the cavity whose region and tags are copied
  };
  struct NewFace {
    std::array<Index, 3> corners;
    Index like;  ///< a face of the mesh whose patch, regions and tag are copied
  };
  /// Tets that replace others and fill the same cavity, or less of it at a boundary. Includes the changing
  /// mesh faces inside the cavity or on its border.
  struct Replacement {
    std::vector<Index> old;
    std::vector<NewTet> created;
    std::vector<Index> old_faces;
    std::vector<NewFace> created_faces;
  };
  /// The tets around an edge ab in order: tet i has the corners a, b, link[i], link[i + 1] and positive
  /// volume. In a closed ring the first link vertex follows the last one; an open ring ends at a boundary.
  struct Ring {
    std::vector<Index> tets, link;
    bool closed;
  };

  /// Keeps a reference to the mesh, whose tets are out of date until `store`. `neighbours` is empty or has an
  /// entry for each tet; only neighbours that are `none` there are searched for.
  explicit TetComplex(TetMesh& mesh, const KnownNeighbours& neighbours = {});

  Index size() const { return static_cast<Index>(tets_.size()); }
  const Tet& operator[](Index tet) const { return tets_[tet]; }
  TetMesh& mesh() { return mesh_; }
  const TetMesh& mesh() const { return mesh_; }
  std::array<Point, 4> corners(Index tet) const;
  bool on_curve(Index a, Index b) const { return curve_edges_.contains(edge_key(a, b)); }
  /// Returns whether ab is an edge of a mesh face. Always true at a pinched vertex a.
  bool on_faces(Index a, Index b) const;

  /// Returns whether the vertex is a corner of any tet.
  bool in_use(Index vertex) const { return vertex_tet_[vertex] != none; }
  /// Returns whether the vertex is pinched: some of its tets share no face with the others, as where bodies
  /// touch. Its star is then incomplete.
  bool pinched(Index vertex) const { return pinched_.contains(vertex); }
  /// Replaces `found` by the tets around a vertex that are connected by faces.
  void star(Index vertex, std::vector<Index>& found) const;
  /// Returns a tet with these two corners; none if they are not joined.
  Index tet_at_edge(Index a, Index b) const;
  /// Replaces `ring` by the ring of the edge ab of a tet.
  void ring(Index tet, Index a, Index b, Ring& ring) const;

  /// Adds a vertex on a feature; no tet has it yet.
  Index add_vertex(const Point& p, const TetMesh::VertexFeature& feature);
  /// Replaces tets. Returns the new tets' indices, valid until the next call.
  std::span<const Index> replace(const Replacement& replacement);
  /// Returns the mesh faces that the last replacement made.
  std::span<const Index> created_faces() const { return created_faces_; }
  /// Removes a vertex of a curve: one edge between `before` and `after` replaces its two edges.
  void join_curve_edges(Index before, Index vertex, Index after);
  /// Inserts a vertex into a curve: two edges replace the edge between `before` and `after`.
  void divide_curve_edge(Index before, Index vertex, Index after);
  /// Returns the mesh edge on a curve that joins these vertices. Precondition: on_curve(a, b).
  Index curve_edge(Index a, Index b) const { return curve_edges_.at(edge_key(a, b)); }

  /// Moves a vertex; connections of tets and faces stay.
  void move_vertex(Index vertex, const Point& p);

  /// Begins a trial: later changes can be undone until `keep`.
  void begin_trial();
  void keep();
  void undo();

  /// Turns the cells in the balls of collars into ordinary tets.
  void forget_balls();

  /// Writes the tets back to the mesh, leaving out removed vertices and faces.
  void store();
  /// Returns the mesh that `store` would write, and leaves the mesh as it is.
  TetMesh stored() const;

 private:
  /// Makes a complex on a copy of the mesh of another complex. It can only be stored.
  TetComplex(TetMesh& copy, const TetComplex& of)
      : mesh_(copy), tets_(of.tets_), origin_(of.origin_), lost_vertices_(of.lost_vertices_) {}

  struct OpenFace {
    std::array<Index, 3> key;  // sorted
    Index tet;
    unsigned corner;
    Index face;
  };

  /// The data of a mesh face.
  struct FaceRecord {
    std::array<Index, 3> corners;
    Index patch;
    Tag tag;
    std::array<Index, 2> regions;
  };
  // Two edges on a curve and the edge that replaces them, or the reverse.
  struct CurveEdges {
    bool joined;
    std::uint64_t first, second, whole;  // edge keys
    Index kept, other;                   // edges of the mesh
    std::array<Index, 2> kept_ends, other_ends;
  };

  void link(bool some_are_known);
  void find_pinched_vertices();
  void make_faces(const Replacement& replacement);
  void set_face(const std::array<Index, 3>& corners, Index face);
  void set_neighbour(Index tet, unsigned corner, Index neighbour);
  void set_face_of_tet(Index tet, unsigned corner, Index face);
  void set_vertex_tet(Index vertex, Index tet);
  FaceRecord face_record(Index face) const;
  void set_face_record(Index face, const FaceRecord& record);
  void undo_curve_edges();
  void drop_lost_faces_and_edges();
  void drop_lost_vertices();
  unsigned corner_across(Index tet, const std::array<Index, 3>& sorted_face) const;

  TetMesh& mesh_;
  LargeVector<Tet> tets_;
  std::vector<Index> origin_;  // by tet: the tet of the mesh whose tags it has
  std::vector<Index> vertex_tet_;
  std::unordered_set<Index> pinched_;
  std::vector<std::uint32_t> stamps_;
  std::uint32_t stamp_ = 0;
  std::unordered_map<std::uint64_t, Index> curve_edges_;  // indices among the mesh's edges, by edge key
  std::vector<Index> free_, free_faces_;
  std::vector<Index> created_, created_faces_;
  std::vector<std::pair<Index, Index>> tags_;  // region and origin of the new tets
  struct FaceTags {
    Index patch;
    Tag tag;
    std::array<Index, 2> regions;
  };
  std::vector<FaceTags> face_tags_;  // tags of the new faces
  std::vector<Index> cavity_vertices_;
  std::vector<Index> lost_vertices_;
  std::vector<OpenFace> open_;

  // The state before a trial.
  bool on_trial_ = false;
  UndoLog<Tet, LargeVector<Tet>> old_tets_;
  UndoLog<Index> old_origins_, old_vertex_tets_, old_lost_vertices_;
  UndoLog<Point> old_points_;
  UndoStack<Index> free_steps_, free_face_steps_;
  std::vector<std::pair<Index, FaceRecord>> old_faces_;
  std::size_t face_count_ = 0, edge_count_ = 0;
  std::vector<CurveEdges> old_edges_;
};

}  // namespace collarmesh::improvement
