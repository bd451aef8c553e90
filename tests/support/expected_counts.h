#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace collarmesh::testing {

/// Expects a count to be within the limits of the row with this key in tests/expected_counts.tsv: its
/// expected count times its least and its largest ratio. If the environment variable COLLARMESH_COUNTED names
/// a file, appends the key and the count to this file, from which `tests/habits/expected_counts.py --renew`
/// renews the table.
void expect_count(const std::string& key, double count);
inline void expect_count(const std::string& key, std::size_t count) {
  expect_count(key, static_cast<double>(count));
}

/// Returns the keys of tests/expected_counts.tsv that begin with this prefix.
std::vector<std::string> expected_keys(const std::string& prefix);

}  // namespace collarmesh::testing
