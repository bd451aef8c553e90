#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::io {

/// A map from the numbers that a file gives to its nodes or elements to indices. Cost of `find`: constant if
/// the numbers are consecutive, otherwise logarithmic.
class NumberTable {
 public:
  /// Adds the number of the next node or element.
  void add(std::int64_t number) { numbers_.emplace_back(number, static_cast<Index>(numbers_.size())); }

  /// Sorts the numbers; call it after the last `add`. Returns a number that was given twice, if there is one.
  std::optional<std::int64_t> sort() {
    if (!std::is_sorted(numbers_.begin(), numbers_.end())) std::sort(numbers_.begin(), numbers_.end());
    const auto twice = std::adjacent_find(numbers_.begin(), numbers_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twice != numbers_.end()) return twice->first;
    return std::nullopt;
  }

  /// Returns the index of a number; `none` if it does not occur. Precondition: the numbers are sorted.
  Index find(std::int64_t number) const {
    if (numbers_.empty() || number < numbers_.front().first || number > numbers_.back().first) return none;
    // The guess is exact for consecutive numbers.
    const auto guess =
        static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(numbers_.front().first);
    if (guess < numbers_.size() && numbers_[guess].first == number) return numbers_[guess].second;
    const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), std::pair(number, Index{0}));
    return found != numbers_.end() && found->first == number ? found->second : none;
  }

  std::size_t size() const { return numbers_.size(); }

 private:
  std::vector<std::pair<std::int64_t, Index>> numbers_;
};

}  // namespace collarmesh::io
