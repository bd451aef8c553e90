#pragma once

#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/layers.h"
#include "collarmesh/second_order.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::guarantee {

/// Walls keep their triangles and edges; cells of layers lie on walls, in as many layers as asked for; the
/// reported areas are those that the cells cover.
inline constexpr char layer_walls[] = "layer_walls";

}  // namespace collarmesh::guarantee

namespace collarmesh::checks {

/// How many layers are asked for, by patch and by the region in which the layers lie.
using AskedWalls = std::map<std::pair<Index, Index>, unsigned>;

/// The triangles of walls, and the curve edges that are sides of these triangles, identified by the positions
/// of their corners.
struct WallGeometry {
  struct Triangle {
    std::array<Point, 3> corners;  ///< the lexicographically lowest one first
    Index patch, face;
  };
  struct Edge {
    std::array<Point, 2> ends;  ///< the lower one first
    Index curve, edge;
  };
  /// A mid-edge node of a side of a triangle.
  struct MidNode {
    std::array<Point, 2> ends;  ///< the lower one first
    Point place;
    std::array<Index, 2> edge;  ///< points of the mesh
    Index node;
  };
  WallGeometry(const TetMesh& mesh, const AskedWalls& walls);

  std::vector<Triangle> triangles;  ///< sorted
  std::vector<Edge> edges;          ///< sorted
  std::vector<MidNode> mid_nodes;   ///< sorted by their ends, with duplicates; empty in first order
};

/// Checks layers against the walls that were asked for and against the mesh before layers were made: the
/// triangles and edges of walls are the same, and so are their mid-edge nodes, except those listed as
/// straightened; each cell of a layer lies above one triangle of a wall; above a triangle, all layers have
/// the same cells: either a prism, perhaps cut into tets and pyramids, which covers the triangle; or only
/// some of these tets and pyramids, which do not cover it; or none; area and covered area of each patch are
/// those that `layers` reports. Adds findings. Cost: O(n log n).
void check_layer_walls(const AskedWalls& walls, const WallGeometry& before, const TetMesh& mesh,
                       const LayersReport& layers, CheckReport& report,
                       std::span<const SecondOrderReport::Straightened> straightened = {});

}  // namespace collarmesh::checks
