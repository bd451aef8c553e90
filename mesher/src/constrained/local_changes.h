#pragma once

#include <optional>
#include <unordered_set>
#include <vector>

#include "constrained/tetrahedra.h"

namespace collarmesh::constrained {

/// A counter of the obstacles to a missing edge or triangle.
class Obstacles {
 public:
  virtual ~Obstacles() = default;
  /// Returns 1 if this face of the mesh would be an obstacle, else 0.
  virtual int face(Index a, Index b, Index c) const = 0;
  /// Returns 1 if this edge of the mesh would be an obstacle, else 0.
  virtual int edge(Index a, Index b) const = 0;
};

/// The local changes of a mesh: reconnections of a few tetrahedra, and insertions of points. Required edges
/// and faces that carry a facet stay.
class LocalChanges {
 public:
  /// Keeps references to both arguments. Required edges are given by their keys.
  LocalChanges(Tetrahedra& mesh, const std::unordered_set<std::uint64_t>& required)
      : mesh_(mesh), required_(required) {}

  /// The next two functions return the increase of the number of obstacles, or nothing if the change is not
  /// possible.

  /// Replaces the two tetrahedra at a face by three at the edge that joins the corners opposite it.
  std::optional<int> remove_face(const Tetrahedra::Face& face, const Obstacles& obstacles);
  /// Removes an edge by the triangulation of its ring that has the fewest obstacles. If every triangulation
  /// makes a tetrahedron without positive volume, or adds more than `most` obstacles, removes other edges
  /// around this edge first, recursively to `depth` levels.
  std::optional<int> remove_edge(Index a, Index b, unsigned depth, const Obstacles& obstacles, int most);

  /// Lets `remove_edge` triangulate this many more rings. From then on it removes no other edges first.
  void set_budget(std::size_t rings) { budget_ = rings; }

  /// Inserts a point in or near some tetrahedra: replaces these, and as many neighbours as necessary, by
  /// tetrahedra with this point. Returns its number, or none if a required edge, a vertex, a facet or the
  /// outer border is in the way, or if too many tetrahedra would be replaced.
  Index insert(const Point& p, std::vector<Index> cavity);

 private:
  static constexpr int any_number = 1 << 20;
  // Limits: larger rings are not triangulated, and larger cavities not filled.
  static constexpr std::size_t largest_ring = 40, largest_cavity = 200;

  std::optional<int> triangulate_ring(Index a, Index b, const Tetrahedra::Ring& ring,
                                      const Obstacles& obstacles, int most);
  bool may_remove(Index a, Index b, const Tetrahedra::Ring& ring) const;
  int cost_of_diagonal(Index a, Index b, Index p, Index q, const Obstacles& obstacles) const;
  void collect(Index a, Index b, const std::vector<Index>& link, std::size_t i, std::size_t j,
               std::vector<Tetrahedra::Corners>& created) const;
  bool grow(Index x, std::vector<Index>& cavity) const;
  bool keeps_features(const std::vector<Index>& cavity,
                      const std::vector<Tetrahedra::Corners>& created) const;

  Tetrahedra& mesh_;
  const std::unordered_set<std::uint64_t>& required_;
  std::size_t budget_ = 0;
  std::vector<int> least_;          // by i * n + j: fewest obstacles of the ring's part from i to j
  std::vector<std::size_t> third_;  // the third corner of the triangle on ij in that triangulation
};

}  // namespace collarmesh::constrained
