#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/growing_array.h"
#include "location/triangle_hierarchy.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// The elements of the complex near each mesh vertex, as nodes of a hierarchy over all elements: coarse nodes
/// while the vertex's Voronoi cell is large.
///
/// Invariant: the nodes of a vertex cover every element that meets the box of its Voronoi cell. There may be
/// more nodes; they are filtered now and then. The loop reports insertions, BlockRefinement reports those
/// into blocks; all parts query it.
class SurfaceNodes {
 public:
  /// Gives every existing vertex the root node of the hierarchy. Keeps references to both arguments.
  SurfaceNodes(const Domain& domain, const RefinedMesh& mesh);

  const TriangleHierarchy& hierarchy() const { return hierarchy_; }
  std::span<const Index> at(Index vertex) const { return {lists_[vertex].nodes, lists_[vertex].count}; }
  bool any_at(Index vertex) const { return lists_[vertex].count > 0; }
  /// Returns the nodes of that corner of a face which has the fewest. They cover everything that the face's
  /// dual edge meets.
  std::span<const Index> fewest(FaceId face) const;
  /// Replaces `found` by the triangles that the dual edge of a face crosses, in the direction out of the
  /// face's cell.
  void crossings_of_dual_edge(FaceId face, std::vector<TriangleHierarchy::Crossing>& found) const;
  /// Replaces `found` by all triangles that a segment crosses.
  void crossings(const Point& p, const Point& q, std::vector<TriangleHierarchy::Crossing>& found) const {
    const Index root = hierarchy_.root();
    hierarchy_.crossings(p, q, {&root, 1}, found);
  }
  /// Returns the triangle of a patch nearest to p, if its squared distance is below `within_squared`, and
  /// sets `within_squared` to that distance; else returns none.
  Index nearest_triangle(const Point& p, Index patch, double& within_squared) const;

  void cells_made(const ConflictZone& zone, Index vertex);

  /// The data of a thread that inserts into blocks: scratch data, and the lists that it has made.
  /// SurfaceNodes points into these lists, so they must exist as long as SurfaceNodes is used.
  class Workspace {
   public:
    /// Returns the bytes of the lists: their sum over all threads does not depend on which thread made which.
    std::size_t bytes() const { return reserved_ * sizeof(Index); }

   private:
    friend class SurfaceNodes;
    Index* reserve(std::size_t count);

    std::vector<std::unique_ptr<Index[]>> chunks_;
    Index* end_ = nullptr;  // end of the last chunk
    std::size_t left_ = 0;  // free entries in the last chunk
    std::size_t reserved_ = 0;
    TriangleHierarchy::Marks marks_;
    std::vector<Index> seeds_, found_, cells_;
  };
  /// Makes room for all vertices before some are inserted into blocks.
  void fit_mesh();
  /// Version of `cells_made` for an insertion into a block. Several threads may call it, each with its own
  /// block.
  void cells_made(const ConflictZone& zone, Index vertex, const Triangulation::Block& block,
                  Workspace& workspace);
  /// Renumbers vertices after blocks were joined.
  void renumber(const Renumbering& renumbering) { renumbering.apply(lists_); }

  std::size_t bytes() const {
    return hierarchy_.bytes() + patch_below_.capacity() * sizeof(Index) + lists_.bytes() +
           workspace_.bytes() + workspace_.marks_.bytes();
  }

 private:
  struct List {
    Index* nodes = nullptr;  // in a chunk of a workspace
    Index count = 0;
    std::uint16_t insertions_left = 0;  // insertions in the vertex's star before its nodes are filtered again
  };
  template <class IncidentCells>
  void cells_made(const ConflictZone& zone, Index vertex, Workspace& w, const IncidentCells& incident_cells);
  void find(const std::vector<Index>& cells, Workspace& w) const;
  void expect_insertions(Index vertex, std::size_t star);
  void store(List& list, Workspace& w);

  const Domain& domain_;
  const RefinedMesh& mesh_;
  TriangleHierarchy hierarchy_;
  std::vector<Index> patch_below_;  // by node: the patch of all elements below, none if they differ
  GrowingArray<List> lists_;        // by vertex
  Workspace workspace_;             // the main loop's own
};

}  // namespace collarmesh
