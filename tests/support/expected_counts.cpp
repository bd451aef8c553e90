#include "support/expected_counts.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace collarmesh::testing {
namespace {

struct ExpectedCount {
  double count = 0, least_ratio = 0, most_ratio = 0;
  std::string counted;  ///< says for people what is counted
};

std::map<std::string, ExpectedCount> read_expected_counts() {
  std::map<std::string, ExpectedCount> table;
  std::ifstream file(COLLARMESH_CHECKOUT "/tests/expected_counts.tsv");
  for (std::string line, key; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream row(line);
    ExpectedCount expected;
    std::getline(row, key, '\t');
    row >> expected.count >> expected.least_ratio >> expected.most_ratio >> std::ws;
    std::getline(row, expected.counted);
    table[key] = expected;
  }
  return table;
}

const std::map<std::string, ExpectedCount>& expected_counts() {
  static const std::map<std::string, ExpectedCount> table = read_expected_counts();
  return table;
}

void append_counted(const std::string& key, double count) {
  if (const char* path = std::getenv("COLLARMESH_COUNTED"))
    std::ofstream(path, std::ios::app) << key << '\t' << count << '\n';
}

}  // namespace

void expect_count(const std::string& key, double count) {
  append_counted(key, count);
  const auto found = expected_counts().find(key);
  ASSERT_TRUE(found != expected_counts().end())
      << "tests/expected_counts.tsv has no row " << key << "; the count is " << count;
  const auto& [expected, least, most, counted] = found->second;
  EXPECT_TRUE(count >= least * expected && count <= most * expected)
      << key << " (" << counted << "): the count is " << count << ", allowed are " << least * expected
      << " to " << most * expected << ", which is " << least << " to " << most << " times " << expected
      << ". If the change is intended, put the new count in this row of tests/expected_counts.tsv";
}

std::vector<std::string> expected_keys(const std::string& prefix) {
  std::vector<std::string> keys;
  for (const auto& [key, expected] : expected_counts())
    if (key.starts_with(prefix)) keys.push_back(key);
  return keys;
}

}  // namespace collarmesh::testing
