#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The result of cutting facets along their intersections.
struct ArrangementReport {
  std::size_t intersecting_pairs = 0;  ///< intersecting pairs of triangles, segments and points in the first
                                       ///< round
  std::size_t cut_triangles = 0;
  std::size_t rounds = 0;
  bool clean = false;         ///< no intersection is left
  std::vector<Point> places;  ///< some places of these pairs
};

/// The merges of near corners that `arrange` keeps.
enum class KeptMerges {
  all,  ///< all merges; merging pauses, or resumes, after each round of cutting that does not lower the
        ///< number of intersections
  where_nothing_meets  ///< only merges at places where no facets intersect afterwards
};

/// Cuts the triangles and segments of a draft along their intersections until they only meet in common
/// corners and edges. Points are constructed exactly, then rounded. Corners that come within `grain`
/// (absolute) of other corners or edges are merged with them; intersections that merges cause are cut in
/// further rounds. Merging pauses while it keeps the number of intersections from falling. If it is paused at
/// the end, it is tried once more, and undone if facets intersect afterwards. Triangles that cover each other
/// become copies of one triangle, and copies stay, because their orientations tell what is inside. Only
/// merging cancels opposite copies of one soup, unless `cancel_duplicates` is false. Throws WorkStopped; the
/// draft is then unusable. Pieces keep their triangle's origin, except `Origin::facet`, which is renumbered.
/// Cost: O(n log n), and for k intersecting pairs O(k log k) exact constructions.
ArrangementReport arrange(facets::ComplexDraft& draft, double grain, Work* work = nullptr,
                          bool cancel_duplicates = true, KeptMerges kept = KeptMerges::all);

/// Merges points with equal coordinates, and drops triangles and segments that thereby lose a corner.
void unify_equal_points(facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
