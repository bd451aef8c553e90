#pragma once

#include <algorithm>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Looks for an index in a short, unsorted range.
bool contains(const auto& range, Index index) {
  return std::find(range.begin(), range.end(), index) != range.end();
}

}  // namespace collarmesh
