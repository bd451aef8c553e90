#include "remesh/undo_log.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace collarmesh::undo_log_test {
namespace {

using remeshing::UndoLog;

// Changes, adds and removes entries at random.
void change(std::vector<int>& values, UndoLog<std::vector<int>>& log, std::mt19937& random) {
  const int value = static_cast<int>(random() % 1000);
  switch (random() % 3) {
    case 0: values.push_back(value); break;
    case 1:
      if (!values.empty()) {
        const int last = values.back();
        EXPECT_EQ(log.pop(), last);
      }
      break;
    default:
      if (!values.empty()) log.set(random() % values.size(), value);
  }
}

TEST(UndoLog, RestoresAnArrayThatGrewAndShrank) {
  std::mt19937 random(1);
  for (unsigned trial = 0; trial < 1000; ++trial) {
    std::vector<int> values(random() % 20);
    for (int& value : values) value = static_cast<int>(random() % 1000);
    UndoLog log(values);
    const std::vector<int> before = values;
    log.begin();
    EXPECT_EQ(log.size_before(), before.size());
    for (unsigned step = 0; step < 30; ++step) change(values, log, random);
    log.undo();
    EXPECT_EQ(values, before);
  }
}

TEST(UndoLog, KeepsWhatWasKeptAndForgetsEarlierTrials) {
  std::vector<int> values{1, 2, 3};
  UndoLog log(values);
  log.begin();
  log.set(0, 4);
  log.keep();
  log.set(1, 5);  // outside of trials
  log.begin();
  log.set(2, 6);
  ASSERT_EQ(log.noted().size(), 1U);
  EXPECT_EQ(log.noted()[0].second, 3);
  log.undo();
  EXPECT_EQ(values, (std::vector<int>{4, 5, 3}));
}

}  // namespace
}  // namespace collarmesh::undo_log_test
