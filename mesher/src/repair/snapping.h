#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The result of snapping.
struct SnapReport {
  std::size_t merged_points = 0;        ///< points merged with another one
  std::size_t cut_edges = 0;            ///< edges that got a corner lying near them
  std::size_t cut_triangles = 0;        ///< triangles that got a corner lying near them
  std::size_t cancelled_triangles = 0;  ///< triangles that lay on one of opposite orientation
  double largest_distance = 0;          ///< absolute: largest move of a corner
  std::vector<Point> places;            ///< some of the places

  std::size_t changes() const { return merged_points + cut_edges + cut_triangles; }
  bool changed() const { return changes() + cancelled_triangles > 0; }
};

/// The features that take part.
enum class SnapWhat {
  all,      ///< corners, edges and triangles
  corners,  ///< corners to each other and to edges
  borders   ///< border edges and their ends in the same way
};

/// Makes corners, edges and triangles meet that come within `distance` (absolute) of each other without
/// meeting: merges points, gives edges and triangles the corner near them, and gives two edges a common
/// corner in between. This removes short edges, needles, caps, slits and T-junctions. Surfaces stay closed:
/// as chains, triangles change by boundaries only. They may intersect afterwards. Runs until nothing is near
/// or a number of rounds is over; a few places may not settle and stay as they are. Pairs of `known`
/// triangles (by number; empty: none) are known not to be near and are skipped. Triangles that come to lie on
/// others of opposite orientation are removed with them, unless `cancel` is false. Throws WorkStopped; the
/// draft is then unusable. Cost: O(n log n + k) for k pairs of near neighbours; each round after the first
/// one only visits changed places.
SnapReport snap_near_features(facets::Draft& draft, double distance, SnapWhat what = SnapWhat::all,
                              Work* work = nullptr, const std::vector<bool>& known = {}, bool cancel = true);

}  // namespace collarmesh::repairing
