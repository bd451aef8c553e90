#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace collarmesh {

/// Returns the place of the n-th byte of a text, counted from 1: "line 3, column 7".
inline std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const auto lines = std::ranges::count(before, '\n');
  const std::size_t begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return "line " + std::to_string(lines + 1) + ", column " + std::to_string(before.size() - begin + 1);
}

}  // namespace collarmesh
