#pragma once

#include <cstddef>
#include <string>

namespace collarmesh::testing {

/// Expects a count to be as in the row with this key of tests/expected_counts.tsv, within the ratios of that
/// row: both more and less is a failure. If the environment variable COLLARMESH_COUNTED names a file, the key
/// and the count are appended to it, from which `tests/habits/expected_counts.py --renew` renews the table.
void expect_count(const std::string& key, double count);
inline void expect_count(const std::string& key, std::size_t count) {
  expect_count(key, static_cast<double>(count));
}

}  // namespace collarmesh::testing
