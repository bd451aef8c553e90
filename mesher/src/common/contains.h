#pragma once

#include <algorithm>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns whether a short, unsorted range contains an index.
bool contains(const auto& range, Index index) {
  return std::find(range.begin(), range.end(), index) != range.end();
}

}  // namespace collarmesh
