#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Triangles between the nodes of a plane outline. `crossings` are further nodes where chords cross, numbered
/// after the others.
struct OutlineTriangles {
  std::vector<std::array<Index, 3>> triangles;  ///< counterclockwise
  std::vector<std::array<double, 2>> crossings;
};

/// Returns the constrained Delaunay triangles that an odd number of chords separates from the outside. Nodes
/// without chords are inner points. Cost: n log n.
OutlineTriangles triangulate_outline(const std::vector<std::array<double, 2>>& nodes,
                                     const std::vector<std::array<Index, 2>>& chords);

}  // namespace collarmesh::brep
