#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct SecondOrderOptions {
  /// The exact geometry; where it returns no point, or is empty, the complex's polylines and triangles count.
  ExactGeometry exact = {};
  double least_jacobian = 0.1;  ///< lower bound on the Jacobian everywhere in a curved tet, relative to that
                                ///< of the straight tet; 0: just positive
  /// The bounds of the mesh. Tets that cannot be curved are replaced by others, which may be thin; with a
  /// thin angle of 0 the tets stay.
  Bounds bounds = {};
  unsigned threads = 0;  ///< maximum number of threads; 0: all cores. The result does not depend on it
};

struct SecondOrderReport {
  std::size_t nodes = 0;   ///< number of mid-edge nodes
  std::size_t curved = 0;  ///< nodes on smooth features that are off the middle of their edge

  std::ptrdiff_t more_tets = 0;  ///< change of the number of tets by replacements
  std::size_t moved_inside = 0;  ///< nodes in regions and planar patches moved off the middle of their edge

  /// A mid-edge node that did not stay on its feature, because a tet at it would have been inverted or
  /// nearly so.
  struct Straightened {
    Index point = none;
    std::array<Index, 2> edge{none, none};  ///< the corners of its edge
    TetMesh::VertexFeature feature;
    Tag tag = 0;  ///< tag of the feature
    Point where;
    double distance = 0;  ///< distance from its place on the feature, absolute
  };
  std::vector<Straightened> straightened;  ///< by index of the point
  double seconds = 0;
  bool cancelled = false;  ///< the execution was cancelled: the mesh has first order
};

/// Turns a mesh into one of second order: every edge gets a mid-edge node, shared by all tets, faces and
/// edges there. Nodes on smooth patches and curves lie on these; with exact geometry, all nodes on features
/// lie on it. Other edges stay straight where possible. Where a tet's Jacobian would fall to `least_jacobian`
/// or below (judged by `jacobian_exceeds`),
/// 1. tets that curved edges make flat at a corner, wherever their other nodes lie, are replaced;
/// 2. nodes inside regions, and in the planes of planar patches, move until all tets there are valid;
/// 3. tets for which that does not help are replaced;
/// 4. the nodes at fault move back towards the middles of their edges, as far as necessary.
///
/// Straight tets are valid, so in the end every tet is valid. Vertices keep their numbers; mid-edge nodes
/// follow all of them. Preconditions: `mesh` comes from `generate` for `plc`, first order. Throws OptionError
/// unless 0 <= least_jacobian < 1. Cost: n log n in the tets for each of at most five rounds, and some
/// milliseconds for each tet that is not valid at first.
SecondOrderReport make_second_order(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options = {},
                                    const Execution& execution = {});

}  // namespace collarmesh
