#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// Two points, the smaller index first.
using Edge = std::array<Index, 2>;
inline Edge edge_key(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// A polygon, and the points and edges that its triangulation must have.
struct PolygonCuts {
  std::vector<Index> border;  ///< corners of the polygon
  std::vector<Index> inside;  ///< points inside the polygon
  std::vector<Edge> edges;    ///< edges between any of these points
};

/// Returns the constrained Delaunay triangulation of a nearly planar polygon, in the projection along
/// `normal`, with the points and edges inside it. The triangles are oriented like the polygon. Returns
/// nothing if points coincide or edges cross in the projection.
std::optional<std::vector<facets::Corners>> cut_polygon(const std::vector<Point>& points,
                                                        const Vector& normal, const PolygonCuts& cuts);

}  // namespace collarmesh::repairing
