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

class SharpCorners;

/// Meshes the patches of a complex, in steps: the triangles of the complex become editable; curves are
/// divided by size; long edges are divided and short ones contracted; triangles with poor angles are refined
/// by circumcentres; what that made too fine is coarsened.
class SurfaceMesher {
 public:
  /// Keeps all but the tolerance by reference. The mesh takes the share `most_excess` of the tolerance.
  SurfaceMesher(const Plc& plc, const MeshOptions& options, SurfaceTolerance tolerance, double most_excess,
                const Execution& execution);

  /// Ends early where the execution is cancelled.
  void run();

  /// Moves vertices onto the exact geometry, as far as the angles permit. Precondition: run() was called.
  ProjectReport project(const ExactGeometry& exact, double most_excess);

  /// The mesh, with triangles turned like their patches. Its vertices are numbered anew.
  TetMesh mesh();

  /// For mid-edge nodes.
  Point place_on_patch(Index patch, const Point& p) const { return surfaces_.nearest(patch, p).point; }
  /// Precondition: an edge of the result of mesh().
  Point middle_of_curve_edge(std::size_t edge) const { return middles_[edge]; }

 private:
  void take_complex();
  void divide_curves(const SharpCorners& corners);
  std::vector<double> sag_limits() const;
  void divide_curve_at(Index curve, std::vector<Index>& edges, const std::array<double, 2>& tips,
                       const std::vector<double>& limits);
  void contract_on_curves();
  void divide_long();
  void contract_short(double least_shape);
  void flip_all();
  void smooth();
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
  std::vector<Point> middles_;   // of the edges of mesh()
  std::vector<Index> point_of_;  // of the complex, of the first vertices
  std::vector<Index> flipped_;   // changes of each vertex, and 1, when no edge there was to flip
  std::vector<bool> kept_;       // vertices on curves, where these are divided
};

}  // namespace collarmesh::shells
