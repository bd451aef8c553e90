#pragma once

#include "collarmesh/check.h"
#include "collarmesh/tet_mesh.h"

/// Further names of guarantees, for periodic faces.
namespace collarmesh::guarantee {

inline constexpr char periodic_motion[] = "periodic_motion";    ///< the motion is rigid and keeps orientation
inline constexpr char periodic_nodes[] = "periodic_nodes";      ///< all nodes of both groups are mapped one
                                                                ///< to one
inline constexpr char periodic_places[] = "periodic_places";    ///< images are where the motion takes their
                                                                ///< nodes
inline constexpr char periodic_faces[] = "periodic_faces";      ///< triangles are mapped one to one onto
                                                                ///< triangles with opposite orientation
inline constexpr char periodic_edges[] = "periodic_edges";      ///< edges on curves are mapped one to one
inline constexpr char periodic_corners[] = "periodic_corners";  ///< two maps, applied in either order, lead
                                                                ///< to the same node

}  // namespace collarmesh::guarantee

namespace collarmesh::checks {

/// Checks `TetMesh::periodic` by the mesh alone: each motion is rigid; the nodes of the first group, mid-edge
/// nodes included, are mapped one to one onto those of the second; each image is where the motion takes its
/// node, within rounding; triangles are mapped one to one onto triangles with opposite orientation, because
/// the region lies on opposite sides of the two groups; edges on curves are mapped one to one; where two
/// pairs meet, the order of their maps does not matter. Adds findings. Cost: n log n in the nodes of the
/// groups, and linear in the faces and edges of the mesh for each pair.
void check_periodic(const TetMesh& mesh, CheckReport& report);

}  // namespace collarmesh::checks
