#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct SecondOrderOptions {
  ExactGeometry exact;  ///< where it is empty or gives nothing: the complex' own polyline or triangles
  double least_jacobian =
      0.1;  ///< everywhere in a curved tet, relative to the straight one; 0: positive is enough
  double thin_angle = 0;   ///< degrees, of the mesh's `CoarsenOptions`: vertices may be inserted where a tet would be
                           ///< flat at a corner, and tets be thin there; 0: the tets stay
  double radius_edge = 2;  ///< bound on circumradius / shortest edge: what exceeds it is marked thin
  double distance = 0;     ///< surface distance tolerance of inserted vertices; 0: 1/200 of the diagonal
  unsigned threads = 0;    ///< at most; 0: as many as there are cores. The result does not depend on it
};

struct SecondOrderReport {
  std::size_t nodes = 0;   ///< mid-side nodes
  std::size_t curved = 0;  ///< of them, those that lie off the middle of their edge, on a smooth feature

  std::ptrdiff_t more_tets = 0;  ///< that there are than before, where some could not be curved
  std::size_t moved_inside = 0;  ///< nodes in regions and planar patches that were moved, so that tets are valid

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
  bool cancelled = false;  ///< the mesh is as it was
};

/// Make a mesh one of second order: a node amid every edge, shared by all tets, faces and edges there.
/// Edges inside regions, on planar patches and on straight curves stay straight; the nodes on smooth
/// patches and curves lie on these; with exact geometry, all nodes on features lie on that. Where a
/// tet's Jacobian would then fall to `least_jacobian` or below, by `jacobian_exceeds`, a node inside moves
/// along with the curved edge beside it if that helps; else the nodes at fault are drawn back to the
/// middles of their edges, halving the way two times. Straight tets are valid,
/// so every tet is. Preconditions: `mesh` comes from `generate` for `plc`, first order. Throws OptionError
/// unless 0 <= least_jacobian < 1. Cost: n log n in the tets.
SecondOrderReport make_second_order(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options = {},
                                    const Execution& execution = {});

}  // namespace collarmesh
