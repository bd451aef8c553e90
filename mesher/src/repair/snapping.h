#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// What snapping did.
struct SnapReport {
  std::size_t merged_points = 0;        ///< became one with another
  std::size_t cut_edges = 0;            ///< got a corner that lay near them
  std::size_t cut_triangles = 0;        ///< got a corner that lay near them
  std::size_t cancelled_triangles = 0;  ///< lay on one that was turned the other way
  double largest_distance = 0;          ///< absolute, of a corner from what it became part of
  std::vector<Point> places;            ///< some of them

  std::size_t changes() const { return merged_points + cut_edges + cut_triangles; }
  bool changed() const { return changes() + cancelled_triangles > 0; }
};

/// Which triangles take part.
enum class SnapWhat {
  all,      ///< corners, edges and triangles
  corners,  ///< corners to each other and to edges
  borders   ///< the same of border edges and their ends
};

/// Let corners, edges and triangles that come within `distance` (absolute) of each other without meeting
/// meet: points become one, edges and triangles get the corner that is near them, two edges a common one in
/// between. Short edges, needles, caps, slits and T-junctions vanish by this. Surfaces stay closed: as
/// chains, triangles change by boundaries only. They may intersect afterwards. Runs until nothing is near or
/// a number of rounds is over; a few places may not settle and stay as they are. What is between two `known`
/// triangles (by number; empty: none are) is not looked at: nothing there is near. Triangles that come to lie
/// on others turned the other way vanish with them, unless `cancel` is false. Throws WorkStopped; the draft
/// is then of no use. Cost: O(n log n + k) for k pairs of near neighbours; each round after the first one
/// looks at what the one before has changed.
SnapReport snap_near_features(facets::Draft& draft, double distance, SnapWhat what = SnapWhat::all,
                              Work* work = nullptr, const std::vector<bool>& known = {}, bool cancel = true);

}  // namespace collarmesh::repairing
