#pragma once

#include <cstddef>
#include <vector>

#include "plc/draft.h"

namespace collarmesh::repairing {

/// What snapping did.
struct SnapReport {
  std::size_t merged_points = 0;   ///< became one with another
  std::size_t cut_edges = 0;       ///< got a corner that lay near them
  std::size_t cut_triangles = 0;   ///< got a corner that lay near them
  std::size_t cancelled_triangles = 0;  ///< lay on one that was turned the other way
  double largest_distance = 0;     ///< absolute, of a corner from what it became part of
  std::vector<Point> places;       ///< some of them

  bool changed() const { return merged_points + cut_edges + cut_triangles + cancelled_triangles > 0; }
};

/// Which triangles take part.
enum class SnapWhat {
  all,      ///< corners, edges and triangles
  corners,  ///< corners to each other and to edges
  borders   ///< the same of border edges and their ends
};

/// Let corners, edges and triangles that come within `distance` (absolute) of each other without meeting meet:
/// points become one, edges and triangles get the corner that is near them, two edges a common one in between.
/// Short edges, needles, caps, slits and T-junctions vanish by this. Surfaces stay closed: as chains, triangles
/// change by boundaries only. They may intersect afterwards.
/// Runs until nothing is near or a number of rounds is over.
/// Cost: O(n log n + k) for k pairs of near neighbours, each round.
SnapReport snap_near_features(build::Draft& draft, double distance, SnapWhat what = SnapWhat::all);

/// Drop pairs of triangles of one soup with the same corners that are turned against each other. In a complex,
/// where orientation means nothing, all copies but one.
std::size_t cancel_twins(build::Draft& draft);

}  // namespace collarmesh::repairing
