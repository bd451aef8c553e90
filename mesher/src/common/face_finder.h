#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/flat_table.h"
#include "common/sorted.h"

namespace collarmesh {

/// A search for triangles or quadrangles of a mesh by their corners in any order. Cost: constant per face,
/// expected.
template <std::size_t n>
class PolygonFinder {
 public:
  using Polygon = std::array<Index, n>;

  explicit PolygonFinder(const std::vector<Polygon>& faces) : slots_(64, none) {
    while (slots_.size() < 2 * faces.size()) slots_.resize(2 * slots_.size(), none);
    for (const Polygon& face : faces) {
      keys_.push_back(sorted(face));
      slot(keys_.back()) = static_cast<Index>(keys_.size() - 1);
    }
  }

  /// Returns the last face with these corners; none if there is no such face.
  Index find(const Polygon& corners) { return slot(sorted(corners)); }

  /// Returns whether two polygons with the same corners have the same orientation.
  static bool alike(const Polygon& a, const Polygon& b) {
    const auto at = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
    return b[(at + 1) % n] == a[1];
  }

 private:
  Index& slot(const Polygon& key) {
    return find_slot(slots_, hash_of(key), [&](Index face) { return keys_[face] == key; });
  }

  std::vector<Polygon> keys_;
  std::vector<Index> slots_;
};

using FaceFinder = PolygonFinder<3>;

}  // namespace collarmesh
