#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// Returns which of these triangles cancel. Pairs of triangles of one soup that have the same corners and
/// opposite orientations cancel. In a complex, where orientation has no meaning, all triangles with the same
/// corners cancel, except one. Cost: O(n log n).
std::vector<Index> cancelled_among(const facets::ComplexDraft& draft, const std::vector<Index>& triangles);

/// Drops the triangles that cancel (see `cancelled_among`) and returns their number. Cost: O(n log n).
std::size_t cancel_duplicates(facets::ComplexDraft& draft);

/// Returns whether the oriented surface encloses almost no volume, like a surface that is double everywhere.
bool is_two_sided(const facets::ComplexDraft& draft);

/// Keeps only one of the copies of each triangle in those components that are closed surfaces afterwards. If
/// any were dropped, orients all components consistently, and outwards if closed. A component is connected by
/// corners. Returns the number of dropped triangles. Cost: O(n log n).
std::size_t keep_one_side(facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
