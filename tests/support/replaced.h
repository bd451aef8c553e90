#pragma once

#include <gtest/gtest.h>

#include <string>

namespace collarmesh::testing {

/// Returns the text with its first `from` replaced by `to`. The text must contain `from`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace collarmesh::testing
