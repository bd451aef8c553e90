#pragma once

#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct ProjectOptions {
  Bounds bounds = {};  ///< no tet breaks them; vertices farther than the distance from their feature stay
  double tolerance = 1e-9;  ///< absolute: a vertex that stays nearer to its feature than this is no exception
  unsigned threads = 0;     ///< maximum number; 0: all cores
};

struct ProjectReport {
  /// A vertex that stayed off its feature.
  struct Exception {
    Index point = none;
    unsigned dimension = 2;  ///< of the feature it belongs to
    Index feature = none;
    Point where;
    double distance = 0;  ///< absolute
  };

  std::size_t vertices = 0;      ///< on features with exact geometry
  double largest_move = 0;       ///< of those vertices, absolute; includes moves along their features
  std::size_t moved_inside = 0;  ///< vertices inside regions that made room
  double largest_distance = 0;   ///< from the features afterwards, exceptions included
  std::vector<Exception> exceptions;
};

/// Moves the vertices on curves and patches onto the exact geometry. No tet is inverted, breaks the
/// radius-edge bound or, in a collar, the bound on its dihedral angles: if one would, its corners make room
/// by moving inside their region or along their exact features, and keep faces and edges within half of the
/// distance of the exact geometry. A vertex for which that does not suffice stays where it is; the report
/// lists these exceptions. On curves and patches that are straight or planar in the complex but not in the
/// exact geometry, vertices go only as near as the complex permits. Preconditions: `mesh` comes from
/// `generate` for `plc`, first order; `exact` gives a point that is its own nearest one. Cost: linear in the
/// tets, with a large factor for those that would become invalid.
ProjectReport project_boundary(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact,
                               const ProjectOptions& options = {}, const Execution& execution = {});

}  // namespace collarmesh
