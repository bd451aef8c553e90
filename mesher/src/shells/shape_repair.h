#pragma once

#include <span>
#include <vector>

#include "collarmesh/progress.h"
#include "shells/surface_editor.h"
#include "shells/vertex_fan.h"

namespace collarmesh::shells {

/// The improvement of triangles whose angles are out of bounds: by flips, moves and collapses if that
/// suffices; else by a vertex at the circumcentre or, if that lies beyond a curve, by dividing the curve's
/// edge (J. Ruppert: A Delaunay refinement algorithm for quality 2-dimensional mesh generation, 1995). The
/// vertex is nearer to the shortest edge than the circumcentre is, if that suffices (A. Ungor, Off-centers,
/// 2004).
class ShapeRepair {
 public:
  /// Keeps references to all arguments.
  ShapeRepair(SurfaceComplex& complex, SurfaceEditor& editor, const Execution& execution);

  /// Works until all triangles are good or nothing helps, with at most `most_vertices` new vertices. Returns
  /// the number of triangles that stay out of bounds.
  std::size_t run(std::size_t most_vertices);
  /// Improves triangles with shapes below `wanted`, without new vertices.
  void improve(double wanted);
  /// Moves a vertex if that increases the least shape around it. Returns whether it moved.
  bool move_best(Index vertex);
  /// Divides triangles that are too far from their patches, or to which a point of a patch is too far, with
  /// at most `most_vertices` new vertices. Returns whether it divided any triangle.
  bool approach(std::size_t most_vertices);
  /// Collapses short edges if the shapes stay good.
  void coarsen();

  /// Excludes triangles with all corners on curves from refinement if their height is less than this share of
  /// the target edge length.
  void set_narrowest(double share) { narrowest_ = share; }

  /// Returns the least permitted shape of a triangle, in degrees: `least_angle` or, for a triangle in a sharp
  /// corner of the input, half of the corner's angle.
  double bound(Index triangle) const;

 private:
  bool poor(Index triangle, double wanted) const;
  bool tried(Index triangle, double wanted);
  void note_tried(Index triangle, double wanted);
  /// Returns the poor triangles among `known` and among all from number `first` on, worst first.
  std::vector<Index> poor_triangles(double wanted, std::span<const Index> known, Index first) const;
  bool approach_points(std::size_t limit);
  bool improve_connections(Index triangle, double wanted, bool may_collapse);
  bool improve_by_moves(Index triangle);
  bool move_corners(Index triangle);
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
    std::size_t changes = 0;  // sum of its corners' numbers of changes
    double wanted = 0;
  };
  std::vector<Tried> tried_;          // by triangle: the last attempt that failed
  std::vector<unsigned char> moves_;  // by triangle: number of times its corners were moved
  std::vector<Index> not_movable_;    // by vertex: its number of changes, plus 1, when a move last failed
};

}  // namespace collarmesh::shells
