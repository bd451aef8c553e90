#pragma once

#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "collar/collar_system.h"
#include "collar/gap_size.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/surface_nodes.h"

namespace collarmesh {

/// The gap size by exploring the mesh (paper, Procedure 4): from the Voronoi cell that contains the point
/// breadth first, interviewing what meets the cells, until the ball of the nearest witness is explored.
class GapExplorer final : public GapSize {
 public:
  /// All are kept by reference.
  GapExplorer(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes);

  /// The next query is near this mesh vertex: where its cell is looked for. Each query is near the next.
  void start_near(Index vertex) { near_ = vertex; }

  double at_vertex(Index vertex, double bound = INFINITY) override;
  double on_curve(Index curve, const Point& p, double bound = INFINITY) override;

  /// Is a vertex or curve of the complex isolated in the Voronoi cell of a mesh vertex (paper, Definition 6):
  /// does every feature that meets the cell contain it? What a feature has in the cell does not count where
  /// it lies in one of these balls as a whole: the cell of a point on the sphere of a vertex ball reaches
  /// into the ball, where features come as close as they like.
  bool isolated(const Feature& vertex_or_curve, Index cell, std::span<const CollarBall> except = {});

  std::size_t queries() const { return queries_; }
  /// Vertices whose cells were explored, of all queries.
  std::size_t explored() const { return explored_; }

 private:
  double explore(const Feature& at, const Point& x, double bound);
  /// Calls witness(a, b, c) with what the features that do not contain `at` consist of: below the nodes,
  /// nearer to x than the bound, which may be lowered.
  template <class Witness>
  void interview(std::span<const Index> nodes, const Feature& at, const Point& x, const double& squared_bound,
                 const Witness& witness);
  /// Put what a triangle has in the cell of this vertex, whose neighbours are adjacent_, into polygon_.
  void cut_to_cell(Index vertex, const Point& a, const Point& b, const Point& c);

  const Plc& plc_;
  std::span<const Point> points_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  std::vector<Index> vertex_at_;                       // by point
  std::unordered_map<std::uint64_t, Index> curve_of_;  // by the two points of a segment
  std::unordered_set<Index> interviewed_;              // nodes, in this exploration: large cells share them
  std::vector<Index> fresh_nodes_, adjacent_;
  std::vector<Point> polygon_, clipped_;
  Index near_ = 0;
  std::size_t queries_ = 0, explored_ = 0;
};

}  // namespace collarmesh
