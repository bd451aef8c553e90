#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/repair.h"
#include "facets/draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// Close the holes of each surface: closed curves of edges that one triangle has. They are filled with
/// triangles between their points that turn and spread little (CGAL's triangulation of holes), under a tag of
/// their own for each hole, from `first_tag` on, unless that would need more than `largest_share` of the area
/// of the surface around it: then it is no hole, but an open sheet. Neither holes nor tags depend on the
/// order of points and facets. Throws WorkStopped; the draft is then of no use. Cost: for a hole of k edges
/// O(k^2) in practice.
std::vector<FilledHole> fill_holes(facets::Draft& draft, Tag first_tag, Work* work = nullptr,
                                   double largest_share = 0.6);

/// How many edges have one triangle of a soup only (more precisely: are not run through as often in one
/// direction as in the other).
std::size_t count_open_edges(const facets::Draft& draft);

}  // namespace collarmesh::repairing
