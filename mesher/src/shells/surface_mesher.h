#pragma once

#include <memory>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/progress.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/tet_mesh.h"
#include "location/curve_paths.h"
#include "shells/narrow_places.h"
#include "shells/shape_repair.h"
#include "shells/surface_editor.h"

namespace collarmesh::shells {

class ChordLimits;
class SharpCorners;

/// The mesher of a complex's patches. Its steps: make the triangles of the complex editable; divide curves by
/// size; divide long edges and collapse short ones; refine triangles with poor angles by circumcentres;
/// coarsen places that became too fine.
class SurfaceMesher {
 public:
  /// Keeps all but the tolerance by reference. The mesh may use the share `most_excess` of the tolerance.
  SurfaceMesher(const Plc& plc, const MeshOptions& options, SurfaceTolerance tolerance, double most_excess,
                const Execution& execution);

  /// Runs all steps. Ends early if the execution is cancelled.
  void run();

  /// Moves vertices onto the exact geometry, as far as the angles permit. The mesh may then use the share
  /// `most_excess` of the tolerance. Precondition: run() was called.
  ProjectReport project(const ExactGeometry& exact, double most_excess);

  /// Returns the mesh, with triangles oriented like their patches. Precondition: it was not called before.
  TetMesh mesh();

  /// Returns the place of a patch nearest to p, for mid-edge nodes.
  Point place_on_patch(Index patch, const Point& p) const { return surfaces_.nearest(patch, p).point; }
  /// Returns the middle of an edge along its curve. `edge` is the number of an edge of the result of mesh().
  Point middle_of_curve_edge(std::size_t edge) const { return middles_[edge]; }

 private:
  void take_complex();
  void take_asked_sizes(const std::vector<std::pair<Index, double>>& place_on_curve);
  void divide_curves(const SharpCorners& corners);
  void divide_curve_at(Index curve, std::vector<Index>& edges, const std::array<double, 2>& tips,
                       const ChordLimits& limits);
  void collapse_on_curves();
  void divide_long();
  void collapse_short(double least_shape);
  void flip_all();
  void smooth();
  void remove_needless_vertices();
  bool project_vertex(Index vertex, const Point& target);

  const Plc& plc_;
  const Execution& execution_;
  SurfaceTolerance tolerance_;
  CurvePaths paths_;
  PatchSurfaces surfaces_;
  SurfaceSizes sizes_;
  SurfaceComplex complex_;
  SurfaceEditor editor_;
  ShapeRepair repair_;
  std::vector<Point> middles_;   // middles of the edges of mesh()
  std::vector<Index> point_of_;  // by vertex: the point of the complex that it was made from
  std::vector<Index> flipped_;   // by vertex: its number of changes, plus 1, when its edges were last found
                                 // to need no flip; 0: not yet
  std::vector<bool> kept_;       // by vertex on a curve: whether the curve is divided there
};

}  // namespace collarmesh::shells
