#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "common/edge_key.h"
#include "periodic/cavity.h"

namespace collarmesh::periodicity {

/// The numbers of nodes that changes of a patch inserted and removed, and of edges that they flipped.
struct PatchChange {
  std::size_t inserted = 0, removed = 0, turned = 0;
};

/// An editor of the triangles of a planar patch on the boundary, and of the tets behind it.
class PatchEditor {
 public:
  using Edge = std::array<Index, 2>;

  /// Keeps a reference to the editor. `faces` are the patch's faces in the mesh. Cost: linear in these faces.
  PatchEditor(CavityEditor& editor, const Plc& plc, Index patch, std::span<const Index> faces);

  /// Makes the nodes inside the patch lie at exactly these places: moves nodes that are near a place, inserts
  /// new nodes, and removes the rest if that leaves good tets. Returns the node at each place; none if it
  /// could not be made.
  std::vector<Index> put_nodes(std::span<const Point> places);
  /// Returns the places of the nodes inside the patch that `put_nodes` could not remove.
  std::vector<Point> places_of_others() const;
  /// Adds nodes at these places and returns them, as `put_nodes` does; all other nodes stay.
  std::vector<Index> add_nodes(std::span<const Point> places);
  /// Flips edges until the patch has these edges, as long as all new tets have a quality above `least`. The
  /// ends must be nodes of the patch. If `must`, also inserts vertices below the patch, so that the new tets
  /// are positive. Returns the number of missing edges.
  std::size_t make_edges(std::span<const Edge> edges, double least, bool must);
  /// Returns the edges of the patch, the smaller node of each first.
  std::vector<Edge> edges() const;

  const PatchChange& change() const { return change_; }

 private:
  bool is_inside(Index node) const;
  std::vector<Index> others() const;
  bool has(Index a, Index b) const { return faces_at_.contains(edge_key(a, b)); }
  int side(Index a, Index b, const Point& p) const;
  int side(Index a, Index b, Index c) const { return side(a, b, editor_.at(c)); }
  Index opposite(Index a, Index b) const;
  void add_face(Index face);
  void drop_face(Index face);
  void replace(const Cavity& cavity, Index apex);
  Index replace_by_new(const Cavity& cavity, const Point& apex, const TetMesh::VertexFeature& feature);
  void drop_faces(const Cavity& cavity);
  void add_created_faces();
  Index find_face(const Point& place);
  Index move_one_to(const Point& place);
  Index insert(const Point& place);
  void remove(Index node);
  void make_delaunay(std::vector<Edge> edges);
  bool is_delaunay(Index a, Index b, Index c, Index d) const;
  bool turn(Index a, Index b, double least, bool with_new_vertex);
  bool make_edge(Index a, Index b, double least, bool must);
  std::vector<Edge> crossed(Index a, Index b) const;
  std::pair<double, Point> best_below(const Cavity& cavity, const Point& start) const;
  std::vector<Edge> edges_of_created_faces() const;

  CavityEditor& editor_;
  Index patch_;
  Vector normal_;    // normal, pointing out of the region
  Point viewpoint_;  // a point outside, for telling the left of an edge from its right
  std::unordered_map<std::uint64_t, std::array<Index, 2>> faces_at_;  // by edge
  std::unordered_map<Index, bool> stays_;  // nodes inside the patch, and whether each stays
  Index last_ = none;                      // the face that was made or found last
  PatchChange change_;
};

}  // namespace collarmesh::periodicity
