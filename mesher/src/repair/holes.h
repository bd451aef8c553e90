#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/repair.h"
#include "facets/complex_draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// Closes the holes of each surface: closed curves of edges that only one triangle has. Fills them with
/// triangles between their points, with small dihedral angles and areas (CGAL's triangulation of holes). Each
/// hole gets its own tag, from `first_tag` on. A curve counts as the border of an open sheet, not as a hole,
/// if its filling would need more than `largest_share` of the area of the surface around it. Neither holes
/// nor tags depend on the order of points and facets. Throws WorkStopped; the draft is then unusable. Cost:
/// for a hole of k edges O(k^2) in practice.
std::vector<FilledHole> fill_holes(facets::ComplexDraft& draft, Tag first_tag, Work* work = nullptr,
                                   double largest_share = 0.6);

/// Returns the number of open edges: the sum, over the edges of each soup that is no complex, of how much
/// more often triangles use the edge in one direction than in the other.
std::size_t count_open_edges(const facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
