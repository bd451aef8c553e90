// The table of costs that a run records, from a process of this program whose environment asks for it.
#include "common/recorded_costs.h"

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "collarmesh/usable_threads.h"
#include "support/temporary_file.h"

namespace collarmesh::recorded_costs_test {
namespace {

constexpr std::array workers{2, 4, 8, 16, 32, 64};

void spend(double seconds) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  for (const double end = now() + seconds; now() < end;) {
  }
}

/// Runs parts with known numbers of pieces, in the process that records.
void run_parts() {
  EXPECT_EQ(usable_threads(), 5);
  const recorded_costs::Place here{"/somewhere/mesher/here.cpp", 12}, nested{"nested.cpp", 7};
  std::vector<std::size_t> order;
  const auto costly = [&order](std::size_t i) {
    order.push_back(i);
    spend(i == 3 ? 0.004 : 0.001);
  };
  recorded_costs::begin_stage("first");
  recorded_costs::run(6, costly, here);
  recorded_costs::run(2, costly, here);
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 0, 1}));
  recorded_costs::write();  // ends the stage
  recorded_costs::begin_stage("first");
  {
    const recorded_costs::StagePart part("inner");
    recorded_costs::run(
        3, [&](std::size_t) { recorded_costs::run(4, costly, nested); }, here);
  }
  order.clear();
  std::thread([&] { recorded_costs::run(3, costly, here); }).join();  // no cost of this thread
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2}));
  spend(0.002);
}

/// The columns of a row after its stage and place, by name.
using Row = std::map<std::string, double>;

std::map<std::pair<std::string, std::string>, Row> rows_of(const std::string& table) {
  std::map<std::pair<std::string, std::string>, Row> rows;
  std::istringstream lines(table);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
    if (names.empty()) {
      names = words;
      continue;
    }
    EXPECT_EQ(words.size(), names.size()) << line;
    for (std::size_t i = 2; i < std::min(words.size(), names.size()); ++i)
      rows[{words[0], words[1]}][names[i]] = std::stod(words[i]);
  }
  return rows;
}

/// Runs this test in a process of its own, which writes the table to a file. Returns its exit status.
int run_recording(const std::string& path) {
  std::vector<std::string> texts{"COLLARMESH_RECORD_COSTS=" + path, "COLLARMESH_CORES=5"};
  for (char** each = environ; *each != nullptr; ++each)
    if (const std::string text = *each; !text.starts_with("GTEST_") && !text.starts_with("COLLARMESH_"))
      texts.push_back(text);
  std::vector<char*> environment;
  for (std::string& text : texts) environment.push_back(text.data());
  environment.push_back(nullptr);
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::string name = "tests", filter = "--gtest_filter=RecordedCosts.*", brief = "--gtest_brief=1";
  std::array<char*, 4> arguments{name.data(), filter.data(), brief.data(), nullptr};
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environment.data()) != 0)
    return -1;
  int status = 0;
  return waitpid(child, &status, 0) == child ? status : -1;
}

TEST(RecordedCosts, AreSumsByStageAndPlaceWithBoundsOnTheTimeOfMoreWorkers) {
  if (recorded_costs::on) return run_parts();
  const testing::TemporaryFolder folder;
  ASSERT_EQ(run_recording(folder.file("costs")), 0);
  auto rows = rows_of(folder.read("costs"));
  Row &flat = rows[{"first", "mesher/here.cpp:12"}], &nested = rows[{"first: inner", "mesher/here.cpp:12"}];
  EXPECT_EQ(flat["parts"], 2);
  EXPECT_EQ(flat["pieces"], 8);
  EXPECT_EQ(nested["parts"], 1);
  EXPECT_EQ(nested["pieces"], 3);
  EXPECT_GE(flat["work"], 0.011);
  EXPECT_GE(nested["work"], 0.021);
  EXPECT_GE((rows[{"first", "end of the stage"}]["serial"]), 0.002);
  EXPECT_FALSE(rows.contains({"first: inner", "nested.cpp:7"})) << "only outermost parts have rows";
  constexpr double rounding = 1e-5;
  for (Row* const row : {&flat, &nested}) {
    double before = (*row)["work"];
    for (const int n : workers) {
      const double span = (*row)["span_" + std::to_string(n)];
      EXPECT_GE(span, (*row)["work"] / n - rounding);
      EXPECT_LE(span, before + rounding);
      before = span;
    }
  }
  // No number of workers divides the longest pieces. A worker that is free takes the next piece, so two of
  // them need at most half of the work and the longest piece.
  EXPECT_GE(flat["span_64"], 0.005);
  EXPECT_LE(flat["span_2"], 0.5 * flat["work"] + flat["span_64"] + rounding);
  EXPECT_GE(nested["span_64"], 0.004);
}

}  // namespace
}  // namespace collarmesh::recorded_costs_test
