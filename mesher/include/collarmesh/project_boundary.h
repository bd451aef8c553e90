#pragma once

#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct ProjectOptions {
  Bounds bounds = {};  ///< bounds that no tet breaks; vertices farther from their feature than the bounds'
                       ///< `distance` stay where they are
  /// Absolute; a vertex that stays nearer than this to its feature is not listed as an exception.
  double tolerance = 1e-9;
  unsigned threads = 0;  ///< maximum number; 0: all cores
};

struct ProjectReport {
  /// A vertex that stayed off its feature.
  struct Exception {
    Index point = none;
    unsigned dimension = 2;  ///< dimension of the feature it belongs to
    Index feature = none;
    Point where;
    double distance = 0;  ///< distance from the feature, absolute
  };

  std::size_t vertices = 0;      ///< vertices on features with exact geometry
  double largest_move = 0;       ///< largest move of these vertices, absolute; includes moves along their
                                 ///< features
  std::size_t moved_inside = 0;  ///< vertices inside regions that moved so that tets stay valid
  double largest_distance = 0;   ///< largest distance from the features afterwards, exceptions included
  std::vector<Exception> exceptions;
};

/// Moves the vertices on curves and patches onto the exact geometry. No move inverts a tet, breaks the
/// radius-edge bound or, in a collar, the bound on dihedral angles. If a move would do so, the tet's other
/// corners first move inside their region or along their exact features, so that faces and edges stay within
/// half of the surface distance (that of `ProjectOptions::bounds`) of the exact geometry. A vertex that
/// cannot reach its place in this way stays where it is; the report lists it as an exception. On curves and
/// patches that are straight or planar in the complex but not in the exact geometry, vertices go only as near
/// as the complex permits. Preconditions: `mesh` comes from `generate` for `plc`, first order; `exact` is
/// idempotent: it does not move points that lie on the geometry. Cost: linear in the tets, with a large
/// factor for those that would become invalid.
ProjectReport project_boundary(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact,
                               const ProjectOptions& options = {}, const Execution& execution = {});

}  // namespace collarmesh
