#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/flat_table.h"

namespace collarmesh::io {

/// Finds the faces of a mesh by their corners in any order. Cost: constant per face, expected.
class FaceFinder {
 public:
  using Triangle = std::array<Index, 3>;

  explicit FaceFinder(const std::vector<Triangle>& faces) : slots_(64, none) {
    while (slots_.size() < 2 * faces.size()) slots_.resize(2 * slots_.size(), none);
    for (const Triangle& face : faces) {
      keys_.push_back(sorted(face));
      slot(keys_.back()) = static_cast<Index>(keys_.size() - 1);
    }
  }

  /// Returns the last face with these corners; none if there is no such face.
  Index find(const Triangle& corners) { return slot(sorted(corners)); }

  /// Returns whether two triangles with the same corners have the same orientation.
  static bool alike(const Triangle& a, const Triangle& b) {
    const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
    return b[(at + 1) % 3] == a[1];
  }

 private:
  static Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  }
  Index& slot(const Triangle& key) {
    std::uint64_t h = key[0];
    h = (h * 0x9e3779b97f4a7c15ULL) ^ key[1];
    h = (h * 0x9e3779b97f4a7c15ULL) ^ key[2];
    h *= 0x9e3779b97f4a7c15ULL;
    return find_slot(slots_, h ^ (h >> 31), [&](Index face) { return keys_[face] == key; });
  }

  std::vector<Triangle> keys_;
  std::vector<Index> slots_;
};

}  // namespace collarmesh::io
