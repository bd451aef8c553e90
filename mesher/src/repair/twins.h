#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// A triangle among others of its soup with the same corners.
struct Twin {
  bool odd;  ///< its corners are an odd permutation of their order, so it is opposite to even ones
  Index triangle;

  friend bool operator==(const Twin& a, const Twin& b) = default;
  friend bool operator<(const Twin& a, const Twin& b) {
    return a.odd != b.odd ? b.odd : a.triangle < b.triangle;
  }
};

/// Returns whether the corners are an odd permutation of the sorted ones.
bool is_odd(const facets::Corners& corners);

/// Returns which of these triangles with the same corners, all those of one soup, cancel each other: pairs of
/// opposite orientation; in a complex, where orientation means nothing, all but one.
std::vector<Index> cancelled_among(std::vector<Twin> twins, bool in_complex);

/// Drops cancelled triangles and returns how many. Cost: O(n log n).
std::size_t cancel_twins(facets::Draft& draft);

/// Returns whether a surface encloses no volume by its orientation, like one that has two sides everywhere.
bool is_two_sided(const facets::Draft& draft);

/// Keeps one of each two opposite copies in closed surfaces that consist of them, with consistent
/// orientation. Returns how many were dropped. Cost: O(n log n).
std::size_t keep_one_side(facets::Draft& draft);

}  // namespace collarmesh::repairing
