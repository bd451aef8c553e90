#pragma once

#include <algorithm>
#include <vector>

namespace collarmesh {

/// Returns the median: the upper one of the two in the middle if the number of values is even; 0 if there are
/// no values. Reorders the values.
inline double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace collarmesh
