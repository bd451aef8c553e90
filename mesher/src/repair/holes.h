#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/repair.h"
#include "facets/complex_draft.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// Closes the holes of each surface: closed curves of edges that only one triangle has. Fills them with
/// triangles between their points. Minimizes first the largest angle between the normals of neighbouring
/// triangles, then the total area (CGAL's triangulation of holes). Each hole gets its own tag, from
/// `first_tag` on. A curve counts as the border of an open sheet, not as a hole, if the area of its filling
/// would exceed `largest_share` of the area of the surface around it. Neither holes nor tags depend on the
/// order of points and facets. Throws WorkStopped; the draft is then unusable. Cost: for a hole of k edges
/// O(k^2) in practice.
std::vector<FilledHole> fill_holes(facets::ComplexDraft& draft, Tag first_tag, Work* work = nullptr,
                                   double largest_share = 0.6);

/// Returns the number of open edges of the soups that are no complexes: an edge that k triangles of a soup
/// use in one direction and m in the other counts |k - m| times.
std::size_t count_open_edges(const facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
