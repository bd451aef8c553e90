#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// What cutting did.
struct ArrangementReport {
  std::size_t intersecting_pairs = 0;  ///< of triangles, segments and points, in the first round
  std::size_t cut_triangles = 0;
  std::size_t rounds = 0;
  bool clean = false;         ///< nothing intersects any more
  std::vector<Point> places;  ///< some points where triangles met, in the first round
};

/// Cut the triangles and segments of a draft along their intersections until they meet in common corners and
/// edges only. Constructions are exact, then rounded, and corners that come within `grain` (absolute) of
/// others or of edges become one with them, unless that undoes the cuts; what intersects by this is cut in
/// further rounds. Where that undid the cuts it is tried once more in the end, and taken back if it does so
/// again. Triangles that cover each other become copies of one: all stay, as their orientations say
/// what is inside; those that arise near others cancel, unless `cancel_twins` is false. Throws WorkStopped;
/// the draft is then of no use. Pieces keep their triangle's origin, but for `Origin::facet`, which is
/// renumbered. Cost: O(n log n) and for k intersecting pairs O(k log k) exact constructions, some 0.1 ms
/// each.
ArrangementReport arrange(facets::Draft& draft, double grain, Work* work = nullptr, bool cancel_twins = true);

/// Make points with equal coordinates one, and drop the triangles and segments that lose a corner in this.
void unify_equal_points(facets::Draft& draft);

}  // namespace collarmesh::repairing
