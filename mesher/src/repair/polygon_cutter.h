#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// Two points, the smaller index first.
using Edge = std::array<Index, 2>;
inline Edge edge_key(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// What a polygon is cut along.
struct PolygonCuts {
  std::vector<Index> border;  ///< the polygon
  std::vector<Index> inside;  ///< points inside of it
  std::vector<Edge> edges;    ///< between any of these points
};

/// The constrained Delaunay triangulation of a polygon that is nearly planar, seen along `normal`, with the
/// points and edges inside. The triangles are oriented like the polygon. Nothing where points coincide or
/// edges cross, seen along the normal.
std::optional<std::vector<facets::Corners>> cut_polygon(const std::vector<Point>& points,
                                                        const Vector& normal, const PolygonCuts& cuts);

}  // namespace collarmesh::repairing
