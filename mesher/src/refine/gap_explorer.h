#pragma once

#include <array>
#include <span>
#include <vector>

#include "collar/collar_system.h"
#include "collar/gap_size.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/surface_nodes.h"

namespace collarmesh {

/// The gap size by exploring the mesh (paper, Procedure 4): from the Voronoi cell that contains the point
/// breadth first, interviewing what meets the cells, until the ball of the nearest witness is explored. What
/// contains the point is left out as a whole, however finely it is tessellated.
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
  /// The witness against it is kept, and asked first.
  bool isolated(const Feature& vertex_or_curve, Index cell, std::span<const CollarBall> except = {});
  /// Is the last witness against the isolation of this vertex or curve still in the cell where it was found?
  bool witness_remains(const Feature& vertex_or_curve, std::span<const CollarBall> except = {});

  std::size_t queries() const { return queries_; }
  /// Vertices whose cells were explored, of all queries.
  std::size_t explored() const { return explored_; }
  /// Elements below the nodes of these cells that were asked for their distance.
  std::size_t interviews() const { return interviews_; }

 private:
  /// What of the complex an element holds besides its triangle: the vertices at its corners, and the curves
  /// from each corner to the next.
  struct Border {
    std::array<Index, 3> vertices{none, none, none}, curves{none, none, none};
  };
  /// Points of what came near a vertex or curve last, but does not contain it, and the cell in which that
  /// kept it from being isolated.
  struct Witness {
    std::array<Index, 3> points{none, none, none};
    Index cell = none;
  };

  void find_borders();
  double explore(const Feature& at, const Point& x, double bound);
  /// Calls witness(a, b, c) with points of what the features that do not contain `at` consist of: below the
  /// nodes, nearer to x than the bound, which may be lowered.
  template <class Found>
  void interview(std::span<const Index> nodes, const Feature& at, const Point& x, const double& squared_bound,
                 const Found& witness);
  Witness& last_witness(const Feature& vertex_or_curve) {
    return witnesses_[vertex_or_curve.index + (vertex_or_curve.dimension == 1 ? plc_.vertices.size() : 0)];
  }
  double squared_distance_to(const std::array<Index, 3>& points, const Point& x) const {
    return squared_distance_to_triangle(x, points_[points[0]], points_[points[1]], points_[points[2]]);
  }
  /// Does a witness reach into this cell, whose neighbours are adjacent_, with more than lies in one of these
  /// balls?
  bool reaches_into(Index cell, const std::array<Index, 3>& points, std::span<const CollarBall> except);
  /// Puts what a triangle has in the cell of this vertex, whose neighbours are adjacent_, into polygon_.
  void cut_to_cell(Index vertex, const Point& a, const Point& b, const Point& c);

  const Plc& plc_;
  std::span<const Point> points_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  std::vector<Border> borders_;             // of elements that have any
  std::vector<Index> border_of_;            // by element; none: only a triangle
  std::vector<Index> patch_below_;          // by node: the patch of all elements below, if none has a border
  std::vector<Witness> witnesses_;          // the last ones, of vertices, then of curves
  std::vector<std::uint32_t> interviewed_;  // by node: in this exploration, if it is the last one's number
  std::uint32_t exploration_ = 0;
  std::vector<Index> fresh_nodes_, adjacent_;
  std::vector<Point> polygon_, clipped_;
  Index near_ = 0;
  std::size_t queries_ = 0, explored_ = 0, interviews_ = 0;
};

}  // namespace collarmesh
