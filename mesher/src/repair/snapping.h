#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The result of snapping.
struct SnapReport {
  std::size_t merged_points = 0;        ///< points merged with another one
  std::size_t cut_edges = 0;            ///< edges into which a near corner was inserted
  std::size_t cut_triangles = 0;        ///< triangles into which a near corner was inserted
  std::size_t cancelled_triangles = 0;  ///< triangles that cancelled with one of opposite orientation
  double largest_distance = 0;          ///< largest move of a corner, absolute
  std::vector<Point> places;            ///< places of some changes

  std::size_t changes() const { return merged_points + cut_edges + cut_triangles; }
  bool changed() const { return changes() + cancelled_triangles > 0; }
};

/// The features that take part in snapping.
enum class SnapWhat {
  all,      ///< corners, edges and triangles with each other
  corners,  ///< corners with each other and with edges
  borders   ///< border edges and their ends with each other
};

/// Makes corners, edges and triangles meet that come within `distance` (absolute) of each other without
/// meeting: merges points, inserts corners into edges and triangles near them, and inserts a common corner
/// into two edges near each other. This removes short edges, needles, caps, slits and T-junctions. Closed
/// surfaces stay closed, but may intersect afterwards.
/// Runs until nothing is near or a number of rounds is over; a few places may not settle and stay as they
/// are. Skips pairs of `known` triangles (by number; empty: none), which are known not to be near. If two
/// triangles of opposite orientation come to coincide, removes both, unless `cancel` is false.
/// Throws WorkStopped; the draft is then unusable. Cost: O(n log n + k) for k pairs of near neighbours; each
/// round after the first one only visits changed places.
SnapReport snap_near_features(facets::ComplexDraft& draft, double distance, SnapWhat what = SnapWhat::all,
                              Work* work = nullptr, const std::vector<bool>& known = {}, bool cancel = true);

}  // namespace collarmesh::repairing
