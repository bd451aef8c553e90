#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/edge_key.h"
#include "common/known_neighbours.h"
#include "common/large_pages.h"
#include "common/tet_sides.h"
#include "remesh/undo_log.h"

namespace collarmesh::remeshing {

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
  /// Tets that replace others and fill the same cavity, or less of it at a boundary; and the mesh faces that
  /// change, inside the cavity or on its border.
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
  std::array<Point, 4> corners(Index tet) const {
    const auto& v = tets_[tet].corners;
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  }
  Vector edge(Index a, Index b) const { return mesh_.points[b] - mesh_.points[a]; }
  bool on_curve(Index a, Index b) const { return curve_edges_.contains(edge_key(a, b)); }
  /// Returns whether ab is an edge of a mesh face or lies on a curve. Returns true if a is pinched.
  bool on_faces(Index a, Index b) const;

  /// Returns whether the vertex is a corner of any tet.
  bool in_use(Index vertex) const { return vertex_tet_[vertex] != none; }
  /// Returns whether the vertex is pinched: its tets are not all connected by faces, as where bodies touch.
  /// Its star is then incomplete.
  bool pinched(Index vertex) const { return pinched_.contains(vertex); }
  /// Replaces `found` by the tets around a vertex. At a pinched vertex, finds only tets that faces connect to
  /// one of them.
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
  Index curve_edge(Index a, Index b) const {
    assert(on_curve(a, b));
    return curve_edges_.at(edge_key(a, b));
  }

  /// Moves a vertex; connections of tets and faces stay.
  void move_vertex(Index vertex, const Point& p) { old_points_.set(vertex, p); }

  /// Begins a trial: later changes can be undone until `keep`.
  void begin_trial();
  void keep();
  void undo();

  /// Turns the cells in the balls of collars into ordinary tets.
  void forget_balls();

  /// Writes the tets back to the mesh, leaving out removed vertices and faces.
  void store() { write(mesh_); }
  /// Returns the mesh that `store` would write, and leaves the mesh as it is.
  TetMesh stored() const {
    TetMesh copy = mesh_;
    write(copy);
    return copy;
  }

 private:
  struct OpenFace {
    std::array<Index, 3> key;  // sorted
    Index tet;
    unsigned corner;
    Index face;
  };

  void link(bool some_are_known);
  void find_pinched_vertices();
  void make_faces(const Replacement& replacement);
  void set_face(const std::array<Index, 3>& corners, Index face);
  /// Returns a tet for changing it, after recording its state for `undo`.
  Tet& changing(Index tet);
  void set_curve_edge(Index edge, const std::array<Index, 2>& ends);
  void forget_curve_edge(std::size_t edge);
  void write(TetMesh& mesh) const;
  void drop_lost_vertices(TetMesh& mesh) const;
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
  UndoLog<LargeVector<Tet>> old_tets_{tets_};
  UndoLog<std::vector<Index>> old_origins_{origin_}, old_vertex_tets_{vertex_tet_},
      old_lost_vertices_{lost_vertices_}, old_free_{free_}, old_free_faces_{free_faces_},
      old_patches_{mesh_.face_patch}, old_curves_{mesh_.edge_curve};
  UndoLog<std::vector<std::uint32_t>> old_stamps_{stamps_};
  UndoLog<std::vector<Point>> old_points_{mesh_.points};
  UndoLog<std::vector<TetMesh::VertexFeature>> old_features_{mesh_.features};
  UndoLog<std::vector<std::array<Index, 3>>> old_faces_{mesh_.faces};
  UndoLog<std::vector<std::array<Index, 2>>> old_face_regions_{mesh_.face_regions}, old_edges_{mesh_.edges};
  UndoLog<std::vector<Tag>> old_face_tags_{mesh_.face_tag}, old_edge_tags_{mesh_.edge_tag};
  auto logs() {
    return std::tie(old_tets_, old_origins_, old_vertex_tets_, old_lost_vertices_, old_free_, old_free_faces_,
                    old_patches_, old_curves_, old_stamps_, old_points_, old_features_, old_faces_,
                    old_face_regions_, old_edges_, old_face_tags_, old_edge_tags_);
  }
};

}  // namespace collarmesh::remeshing
