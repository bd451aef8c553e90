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

/// The gap size, found by exploring the mesh (paper, Procedure 4). The search goes breadth first from the
/// Voronoi cell that contains the point, and computes the distances of the elements that meet each cell. It
/// ends when all cells that are nearer to the point than the nearest element found so far are explored.
/// Features that contain the point are left out as a whole, however finely they are tessellated.
class GapExplorer final : public GapSize {
 public:
  /// Keeps all by reference.
  GapExplorer(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes)
      : plc_(domain.plc),
        points_(domain.points),
        mesh_(mesh),
        nodes_(nodes),
        witnesses_(plc_.vertices.size() + plc_.curves.size()) {
    find_borders();
  }

  /// Makes the next query start near this mesh vertex, not near the place of the query before.
  void start_near(Index vertex) { near_ = vertex; }

  double at_vertex(Index vertex, double bound = INFINITY) override;
  double on_curve(Index curve, const Point& p, double bound = INFINITY) override;

  /// Returns whether a vertex or curve of the complex is isolated in the Voronoi cell of a mesh vertex
  /// (paper, Definition 6): whether every feature that meets the cell contains the vertex or curve. A feature
  /// does not count if its whole part in the cell lies in one of the balls `except`: the cell of a point on
  /// the sphere of a vertex ball reaches into the ball, where features come arbitrarily close. The witness
  /// against isolation is stored, and tested first in the next query.
  bool isolated(const Feature& vertex_or_curve, Index cell, std::span<const CollarBall> except = {});
  /// Returns whether the last witness against the isolation of this vertex or curve is still in the cell
  /// where it was found.
  bool witness_remains(const Feature& vertex_or_curve, std::span<const CollarBall> except = {});

  std::size_t queries() const { return queries_; }
  /// Returns the number of vertices whose cells were explored, over all queries.
  std::size_t explored() const { return explored_; }
  /// Returns the number of elements whose distance was computed, over all queries.
  std::size_t interviews() const { return interviews_; }

 private:
  /// The border of an element: the vertices at its corners, and the curves from each corner to the next.
  struct Border {
    std::array<Index, 3> vertices{none, none, none}, curves{none, none, none};
  };
  /// The last witness against the isolation of a vertex or curve: the corners of an element whose features do
  /// not contain that vertex or curve, and the mesh vertex in whose Voronoi cell the element prevented
  /// isolation.
  struct Witness {
    std::array<Index, 3> points{none, none, none};
    Index cell = none;
  };

  void find_borders();
  double explore(const Feature& at, const Point& x, double bound);
  /// Calls witness(a, b, c) with the points of each element below the nodes, or of each part of its border,
  /// that lies on a feature that does not contain `at`. Skips elements whose boxes are not nearer to x than
  /// the bound. `witness` may lower the bound.
  template <class Found>
  void interview(std::span<const Index> nodes, const Feature& at, const Point& x, const double& squared_bound,
                 const Found& witness);
  Witness& last_witness(const Feature& vertex_or_curve) {
    return witnesses_[vertex_or_curve.index + (vertex_or_curve.dimension == 1 ? plc_.vertices.size() : 0)];
  }
  double squared_distance_to(const std::array<Index, 3>& points, const Point& x) const {
    return squared_distance_to_triangle(x, points_[points[0]], points_[points[1]], points_[points[2]]);
  }
  /// Returns whether a witness has a part in this Voronoi cell that does not lie wholly in one of these
  /// balls. Precondition: adjacent_ are the neighbours of the cell's vertex.
  bool reaches_into(Index cell, const std::array<Index, 3>& points, std::span<const CollarBall> except);
  /// Sets polygon_ to the part of a triangle in the Voronoi cell of this vertex. Precondition: adjacent_ are
  /// the vertex's neighbours.
  void cut_to_cell(Index vertex, const Point& a, const Point& b, const Point& c);

  const Plc& plc_;
  std::span<const Point> points_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  std::vector<Border> borders_;             // borders of the elements that have one
  std::vector<Index> border_of_;            // by element: index in borders_; none: no border
  std::vector<Index> patch_below_;          // by node: the patch of all elements below, if none has a border
  std::vector<Witness> witnesses_;          // last witnesses of vertices, then of curves
  std::vector<std::uint32_t> interviewed_;  // by node: the number of the last exploration that visited it
  std::uint32_t exploration_ = 0;
  std::vector<Index> fresh_nodes_, adjacent_;
  std::vector<Point> polygon_, clipped_;
  Index near_ = 0;
  std::size_t queries_ = 0, explored_ = 0, interviews_ = 0;
};

}  // namespace collarmesh
