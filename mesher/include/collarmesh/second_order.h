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
  ExactGeometry exact = {};  ///< where it is empty or gives nothing: the complex's own polyline or triangles
  double least_jacobian =
      0.1;  ///< everywhere in a curved tet, relative to the straight one; 0: positive is enough
  /// Those of the mesh. Tets that cannot be curved are replaced by others, which may be thin; with a thin
  /// angle of 0 the tets stay.
  Bounds bounds = {};
  unsigned threads = 0;  ///< at most; 0: as many as there are cores. The result does not depend on it
};

struct SecondOrderReport {
  std::size_t nodes = 0;   ///< mid-side nodes
  std::size_t curved = 0;  ///< of them, those that lie off the middle of their edge, on a smooth feature

  std::ptrdiff_t more_tets = 0;  ///< than there were before some were replaced
  std::size_t moved_inside = 0;  ///< nodes in regions and planar patches that left the middle of their edge

  /// A mid-side node that did not stay on its feature, since a tet at it would have been inverted or nearly
  /// so.
  struct Straightened {
    Index point = none;
    std::array<Index, 2> edge{none, none};  ///< its corners
    TetMesh::VertexFeature feature;
    Tag tag = 0;  ///< of the feature
    Point where;
    double distance = 0;  ///< from where it belongs, absolute
  };
  std::vector<Straightened> straightened;  ///< by index of the point
  double seconds = 0;
  bool cancelled = false;  ///< the mesh is one of first order
};

/// Make a mesh one of second order: a node amid every edge, shared by all tets, faces and edges there. The
/// nodes on smooth patches and curves lie on these; with exact geometry, all nodes on features lie on that.
/// Other edges stay straight where they can. Where a tet's Jacobian would fall to `least_jacobian` or below,
/// by `jacobian_exceeds`,
/// 1. tets that curved edges make flat at a corner, wherever other nodes are, are replaced;
/// 2. nodes inside regions, and in the planes of planar patches, move until all tets there are valid;
/// 3. tets for which that does not help are replaced;
/// 4. the nodes at fault are drawn back towards the middles of their edges, as far as is needed.
/// Straight tets are valid, so every tet is. Vertices keep their numbers; mid-side nodes follow all of them.
/// Preconditions: `mesh` comes from `generate` for `plc`, first order. Throws OptionError unless
/// 0 <= least_jacobian < 1. Cost: n log n in the tets, at most five times, and some
/// milliseconds for each tet that is not valid at first.
SecondOrderReport make_second_order(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options = {},
                                    const Execution& execution = {});

}  // namespace collarmesh
