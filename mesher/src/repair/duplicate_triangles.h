#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// One of several triangles of a soup with the same corners.
struct DuplicateTriangle {
  bool odd;  ///< whether its corners are an odd permutation of the sorted ones; odd and even duplicates have
             ///< opposite orientations
  Index triangle;

  friend bool operator==(const DuplicateTriangle& a, const DuplicateTriangle& b) = default;
  friend bool operator<(const DuplicateTriangle& a, const DuplicateTriangle& b) {
    return a.odd != b.odd ? b.odd : a.triangle < b.triangle;
  }
};

/// Returns whether the corners are an odd permutation of the sorted ones.
bool is_odd(const facets::Corners& corners);

/// Returns which triangles cancel, given all triangles of one soup with the same corners. Pairs of opposite
/// orientation cancel; in a complex, where orientation has no meaning, all but one of the triangles cancel.
std::vector<Index> cancelled_among(std::vector<DuplicateTriangle> duplicates, bool in_complex);

/// Drops the triangles that cancel (see `cancelled_among`) and returns their number. Cost: O(n log n).
std::size_t cancel_duplicates(facets::ComplexDraft& draft);

/// Returns whether the oriented surface encloses almost no volume, like a surface that is double everywhere.
bool is_two_sided(const facets::ComplexDraft& draft);

/// Drops all copies but one of each triangle in those components that are closed surfaces afterwards. If any
/// were dropped, orients all components consistently, and outwards if closed. A component is connected by
/// corners. Returns the number of dropped triangles. Cost: O(n log n).
std::size_t keep_one_side(facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
