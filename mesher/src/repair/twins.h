#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// A triangle among others of its soup with the same corners.
struct Twin {
  bool odd;  ///< its corners are an odd permutation of their order: turned against those that are even
  Index triangle;

  friend bool operator==(const Twin& a, const Twin& b) = default;
  friend bool operator<(const Twin& a, const Twin& b) {
    return a.odd != b.odd ? b.odd : a.triangle < b.triangle;
  }
};

/// Is it an odd permutation of its sorted corners?
bool is_odd(const facets::Corners& corners);

/// Which of these triangles with the same corners, all those of one soup, cancel each other: pairs that are
/// turned against each other; in a complex, where orientation means nothing, all but one.
std::vector<Index> cancelled_among(std::vector<Twin> twins, bool in_complex);

/// Drop those of all triangles, and tell how many.
/// Cost: O(n log n).
std::size_t cancel_twins(facets::Draft& draft);

/// Does a surface enclose no volume by its orientation, as one with two sides everywhere?
bool is_two_sided(const facets::Draft& draft);

/// Of closed surfaces whose triangles have copies turned against them keep one of each two, turned alike.
/// Returns how many were dropped. Cost: O(n log n).
std::size_t keep_one_side(facets::Draft& draft);

}  // namespace collarmesh::repairing
