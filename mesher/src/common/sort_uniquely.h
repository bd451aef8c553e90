#pragma once

#include <algorithm>
#include <functional>

namespace collarmesh {

/// Sorts a list by a key and keeps only one item of each key.
template <class Items, class Key = std::identity>
void sort_uniquely(Items& items, const Key& key = {}) {
  std::ranges::sort(items, {}, key);
  const auto same = [&](const auto& a, const auto& b) { return std::invoke(key, a) == std::invoke(key, b); };
  items.erase(std::unique(items.begin(), items.end(), same), items.end());
}

}  // namespace collarmesh
