#pragma once

#include <algorithm>
#include <vector>

namespace collarmesh {

/// Returns the median: the upper one for an even number of values, 0 for none. Reorders the values.
inline double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace collarmesh
