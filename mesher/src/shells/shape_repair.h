#pragma once

#include <span>
#include <vector>

#include "collarmesh/progress.h"
#include "shells/surface_editor.h"
#include "shells/vertex_fan.h"

namespace collarmesh::shells {

/// Makes triangles better whose angles are out of bounds: by flips, moves and contractions where that is
/// enough, else by a vertex at the circumcentre or, where that lies behind a curve, by dividing its edge
/// (J. Ruppert: A Delaunay refinement algorithm for quality 2-dimensional mesh generation, 1995; the vertex
/// is nearer to the shortest edge where that is enough: A. Ungor, Off-centers, 2004).
class ShapeRepair {
 public:
  /// Keeps all by reference.
  ShapeRepair(SurfaceComplex& complex, SurfaceEditor& editor, const Execution& execution);

  /// Works until all triangles are good or nothing helps, with so many new vertices at most. Returns the
  /// number of triangles that stay out of bounds.
  std::size_t run(std::size_t most_vertices);
  /// Improves what is possible without new vertices.
  void improve(double wanted);
  /// Divides triangles that are too far from their patches, with so many new vertices at most.
  /// Returns whether any was.
  bool approach(std::size_t most_vertices);
  /// Contracts edges where the shapes stay good.
  void coarsen();

  /// Triangles between curves are not refined that are lower than this, relative to the target edge length.
  void set_narrowest(double share) { narrowest_ = share; }

  /// The bound on a triangle's shape: less at a sharp corner of the input.
  double bound(Index triangle) const;

 private:
  bool poor(Index triangle, double wanted) const;
  bool tried(Index triangle, double wanted);
  void note_tried(Index triangle, double wanted);
  /// Among those that were poor before, and those from a number on; the worst first.
  std::vector<Index> poor_triangles(double wanted, std::span<const Index> known, Index first) const;
  bool approach_points();
  bool improve_connections(Index triangle, double wanted, bool may_contract);
  bool improve_by_moves(Index triangle);
  bool move_corners(Index triangle);
  bool move_best(Index vertex);
  bool move_within(Index vertex);
  bool move_on_curve(Index vertex, const VertexFan& fan);
  bool move_on_patch(Index vertex, const VertexFan& fan);
  bool too_narrow(Index triangle) const;
  bool refine(Index triangle);
  bool divide_curve_beside(Index triangle, const Point& p);
  bool insert_towards(Index triangle, const Point& p, double nearest);

  SurfaceComplex& complex_;
  SurfaceEditor& editor_;
  const Execution& execution_;
  double narrowest_ = 0;
  struct Tried {
    std::size_t changes = 0;  // of its corners
    double wanted = 0;
  };
  std::vector<Tried> tried_;          // by triangle, the last time in vain
  std::vector<unsigned char> moves_;  // by triangle, of its corners
  std::vector<Index> not_movable_;    // changes of each vertex, and 1, when it was moved in vain
};

}  // namespace collarmesh::shells
