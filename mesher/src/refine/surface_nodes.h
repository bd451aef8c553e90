#pragma once

#include <span>
#include <vector>

#include "common/growing_array.h"
#include "location/triangle_hierarchy.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// What of the complex is found from a mesh vertex: nodes of a hierarchy over all its elements, coarse ones
/// while the vertex' Voronoi cell is large.
///
/// Invariant: the nodes of a vertex cover every element that meets the box of its Voronoi cell. There may be
/// more of them: they are filtered now and then. The loop tells of insertions; all parts ask.
class SurfaceNodes {
 public:
  /// Both are kept by reference. Every vertex that the mesh has gets the root.
  SurfaceNodes(const Domain& domain, const RefinedMesh& mesh);

  const TriangleHierarchy& hierarchy() const { return hierarchy_; }
  std::span<const Index> at(Index vertex) const {
    return {pool_.data() + lists_[vertex].first, lists_[vertex].count};
  }
  bool any_at(Index vertex) const { return lists_[vertex].count > 0; }
  /// Of the vertices of a face those of the one with the fewest: they cover what the face's dual edge meets.
  std::span<const Index> fewest(FaceId face) const;
  /// Replace `found` by the triangles that the dual edge of a face crosses, seen from the face's cell.
  void crossings_of_dual_edge(FaceId face, std::vector<TriangleHierarchy::Crossing>& found) const;
  /// Replace `found` by all triangles that a segment crosses.
  void crossings(const Point& p, const Point& q, std::vector<TriangleHierarchy::Crossing>& found) const {
    const Index root = hierarchy_.root();
    hierarchy_.crossings(p, q, {&root, 1}, found);
  }
  /// The triangle of a patch that is nearest to p, if nearer than this, which becomes its own squared
  /// distance; else none.
  Index nearest_triangle(const Point& p, Index patch, double& within_squared) const;

  void cells_made(const ConflictZone& zone, Index vertex);
  /// Vertices have come between vertices without nodes: they have none, either.
  void quiet_vertices_made();

  std::size_t bytes() const {
    return hierarchy_.bytes() + pool_.bytes() + lists_.bytes();
  }

 private:
  struct List {
    Index first = 0, count = 0;         // in pool_
    std::uint16_t insertions_left = 0;  // in the vertex' star before its nodes are filtered again
  };
  void find(const std::vector<Index>& cells);
  void refresh(Index vertex);
  void expect_insertions(Index vertex, std::size_t star);
  void store(List& list);

  const Domain& domain_;
  const RefinedMesh& mesh_;
  TriangleHierarchy hierarchy_;
  GrowingArray<List> lists_;  // by vertex
  GrowingArray<Index> pool_;
  std::vector<Index> seeds_, found_, cells_;  // scratch
};

}  // namespace collarmesh
