#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "arguments.h"
#include "collarmesh/check.h"
#include "collarmesh/error.h"
#include "collarmesh/mesh_measures.h"
#include "command/guarded.h"
#include "command/progress_display.h"
#include "command/stages.h"
#include "commands.h"
#include "files/input_files.h"
#include "process/process.h"
#include "program.h"
#include "report/report.h"
#include "support/meshes.h"

namespace collarmesh::cli::parts_test {
namespace {

namespace fs = std::filesystem;

class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "collarmesh-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  static void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

  fs::path folder;
};

class StagedFileTest : public FolderTest {
 protected:
  process::Process process;
};

using SimilarFileTest = FolderTest;

TEST(ProgressLine, TellsPhasePercentAndTimeLeft) {
  const std::string line = progress_line("refine", 0.5, 1234567, 3, 200);
  EXPECT_NE(line.find("[############............]  50%  refine"), std::string::npos) << line;
  EXPECT_NE(line.find("1.2M tets"), std::string::npos);
  EXPECT_NE(line.find("3 s left"), std::string::npos);
}

TEST(ProgressLine, FitsTheTerminal) { EXPECT_EQ(progress_line("refine", 1, 10, 3, 20).size(), 20U); }

TEST_F(StagedFileTest, AppearsOnCommitOnly) {
  const fs::path target = folder / "a.txt";
  {
    process::StagedFile file(process.files, target);
    file.write([](const std::string& path) { write(path, "text"); });
    EXPECT_FALSE(fs::exists(target));
    process.files.commit({&file, nullptr});
    EXPECT_TRUE(fs::exists(target));
  }
  EXPECT_EQ(entries(), 1U);
}

TEST_F(StagedFileTest, StaysWhenTheProgramEndsAfterTheCommit) {
  process::StagedFile file(process.files, folder / "a.txt");
  file.write([](const std::string& path) { write(path, "text"); });
  process.files.commit({&file});
  EXPECT_FALSE(process.files.abandon());
  EXPECT_TRUE(fs::exists(folder / "a.txt"));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(StagedFileTest, DisappearsWithoutCommit) {
  {
    process::StagedFile file(process.files, folder / "a.txt");
    file.write([](const std::string& path) { write(path, "text"); });
  }
  EXPECT_EQ(entries(), 0U);
}

TEST_F(StagedFileTest, ErrorsNameTheTarget) {
  process::StagedFile file(process.files, folder / "a.txt");
  try {
    file.write([](const std::string& path) { throw WriteError(path + ": disk full"); });
    FAIL();
  } catch (const WriteError& error) {
    EXPECT_EQ(error.what(), (folder / "a.txt").string() + ": disk full");
  }
}

TEST_F(StagedFileTest, TwoOutputsOfOnePlaceAreAnError) {
  write(folder / "a.txt", "before");
  process::StagedFile first(process.files, folder / "a.txt"), second(process.files, folder / "." / "b.txt");
  first.write([](const std::string& path) { write(path, "first"); });
  second.write([](const std::string& path) {
    write(path, "second");
    write(fs::path(path).replace_filename("a.txt"), "beside it");
  });
  EXPECT_THROW(process.files.commit({&first, &second}), WriteError);
  EXPECT_FALSE(fs::exists(folder / "b.txt"));
  std::string text;
  std::ifstream(folder / "a.txt") >> text;
  EXPECT_EQ(text, "before");
}

TEST_F(StagedFileTest, MissingFolderIsAnError) {
  EXPECT_THROW(process.files.require_writable(folder / "no" / "a.txt"), WriteError);
  EXPECT_THROW(process.files.require_writable(folder), WriteError);
  EXPECT_NO_THROW(process.files.require_writable(folder / "a.txt"));
}

TEST_F(SimilarFileTest, FindsTypos) {
  write(folder / "bracket.off", "");
  write(folder / "box.off", "");
  EXPECT_EQ(files::similar_file(folder / "bracet.off"), folder / "bracket.off");
  EXPECT_EQ(files::similar_file(folder / "BOX.OFF"), folder / "box.off");
  EXPECT_EQ(files::similar_file(folder / "quite_different.stl"), "");
  EXPECT_EQ(files::similar_file(folder / "no" / "box.off"), "");
}

TEST(MeshMeasures, OfOneTet) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_region = {1};
  const MeshMeasures m = measure_mesh(mesh);
  EXPECT_NEAR(m.region_volumes.at(1), 1. / 6, 1e-15);
  EXPECT_NEAR(m.max_dihedral, 90, 1e-9);
  EXPECT_NEAR(m.min_dihedral, 54.7356, 1e-4);
  EXPECT_NEAR(m.max_radius_edge, std::sqrt(3) / 2, 1e-12);
  EXPECT_EQ(m.min_dihedrals[5], 1U);
  EXPECT_EQ(m.radius_edges[3], 1U);
  EXPECT_NEAR(median_edge(mesh), std::sqrt(2), 1e-12);
}

template <class Thrown>
void expect_code(process::ExitCode code, const Thrown& thrown, const std::string& told) {
  process::Process process;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(guarded(process, [&]() -> process::ExitCode { throw thrown; }), code);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find(told), std::string::npos) << said;
}

TEST(Guarded, EveryErrorHasItsCode) {
  process::Process process;
  EXPECT_EQ(guarded(process, [] { return process::ExitCode::guarantee_missed; }),
            process::ExitCode::guarantee_missed);
  expect_code(process::ExitCode::internal_error, std::logic_error("a bug"),
              "internal error: a bug; please report it");
  expect_code(process::ExitCode::usage, OptionError("bad option"), "collarmesh: bad option");
  expect_code(process::ExitCode::unreadable, ReadError("a.off: line 3"), "a.off: line 3");
  expect_code(process::ExitCode::invalid_complex, PlcError("open", {}), "open");
  expect_code(process::ExitCode::cannot_write, WriteError("disk full"), "disk full");
  expect_code(process::ExitCode::budget_hit, std::bad_alloc(), "raise --max-memory, or --size");
  expect_code(process::ExitCode::cancelled, process::Cancelled(), "cancelled");
}

template <class Kind, std::size_t n>
Kind parsed(const std::array<const char*, n>& words) {
  const process::Process process;
  const auto result = parse(process.console, static_cast<int>(n), words.data());
  EXPECT_TRUE(std::holds_alternative<Arguments>(result));
  return std::get<Kind>(std::get<Arguments>(result));
}

TEST(RepairArguments, AreUnderstood) {
  const auto repair = parsed<RepairArguments>(
      std::array{"collarmesh", "repair", "a.stl", "-o", "b.off", "--repair", "wrap", "--repair-tolerance",
                 "1e-4", "--wrap-offset", "0.01", "--json", "--report", "r.json"});
  EXPECT_EQ(repair.inputs, std::vector<std::string>{"a.stl"});
  EXPECT_EQ(repair.output, "b.off");
  EXPECT_EQ(repair.reports, std::vector<std::string>{"r.json"});
  EXPECT_TRUE(repair.json);
  EXPECT_EQ(repair.repair.mode, RepairMode::wrap);
  EXPECT_EQ(repair.repair.tolerance, 1e-4);
  EXPECT_EQ(repair.repair.wrap_offset, 0.01);
}

TEST(RepairArguments, ConvertRepairsOnRequestOnly) {
  EXPECT_FALSE(parsed<ConvertArguments>(std::array{"collarmesh", "convert", "a.stl", "-o", "b.off"}).repairs);
  EXPECT_FALSE(parsed<ConvertArguments>(
                   std::array{"collarmesh", "convert", "a.stl", "-o", "b.off", "--repair", "none"})
                   .repairs);
  EXPECT_TRUE(parsed<ConvertArguments>(
                  std::array{"collarmesh", "convert", "a.stl", "-o", "b.off", "--repair", "auto"})
                  .repairs);
}

RepairReport every_kind_of_repair() {
  RepairReport report;
  report.repaired = report.wrapped = true;
  report.split_polygons = report.dropped_polygons = 1;
  for (RepairPlaces RepairReport::*kind :
       {&RepairReport::repeated, &RepairReport::turned, &RepairReport::stitched, &RepairReport::collapsed,
        &RepairReport::cut, &RepairReport::merged})
    report.*kind = {2, 0.5, {{1, 2, 3}, {4, 5, 6}}};
  report.filled = {{7, 4, 4.0, 1.0, {0.5, 0.5, 0}}};
  report.lost_tags = {3};
  return report;
}

TEST(RepairReports, HaveEveryKind) {
  const auto json = report::repair_json(every_kind_of_repair());
  for (const char* kind : {"repeated", "turned", "stitched", "collapsed", "cut", "merged"}) {
    EXPECT_EQ(json[kind]["count"], 2) << kind;
    EXPECT_EQ(json[kind]["where"].size(), 2U) << kind;
  }
  EXPECT_EQ(json["stitched"]["largest_distance"], 0.5);
  EXPECT_EQ(json["merged"]["area"], 0.5);
  EXPECT_EQ(json["filled"][0]["edges"], 4);
  EXPECT_EQ(json["messages"].size(), describe(every_kind_of_repair()).size());
}

TEST(RepairReports, QuietOnesLeaveOutWhatIsWithinTheTolerance) {
  const std::string all = report::repair_text(every_kind_of_repair()),
                    quiet = report::repair_text(every_kind_of_repair(), true);
  for (const char* word : {"stitched", "collapsed", "repeated", "cut"})
    EXPECT_EQ(quiet.find(word), std::string::npos) << word;
  for (const char* word : {"a hole", "removed", "inside-out", "nothing is left", "wrapped"}) {
    EXPECT_NE(quiet.find(word), std::string::npos) << word;
    EXPECT_NE(all.find(word), std::string::npos) << word;
  }
}

// Includes a stage that never looks at the clock.
TEST(TimeLimitDeathTest, EndsAnyStage) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  process::Process process;
  EXPECT_EXIT(process.run_interruptible([&] {
    process.interrupts.set_time_limit(0.05);
    process.interrupts.note_stage({"check", 0, 7});
    std::this_thread::sleep_for(std::chrono::minutes(10));
    return process::ExitCode::success;
  }),
              ::testing::ExitedWithCode(5),
              "time limit of 0.05 s is reached .stage: check, 7 tets.*--time-limit");
}

TEST(TimeLimitDeathTest, IsWatched) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  process::Process process;
  const auto wait = [&] {
    process.interrupts.set_time_limit(0.05);
    while (!process.interrupts.flag()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.interrupts.stop_if_asked();
    return process::ExitCode::success;
  };
  EXPECT_EXIT(std::exit(static_cast<int>(guarded(process, [&] { return process.run_interruptible(wait); }))),
              ::testing::ExitedWithCode(5), "time limit of 0.05 s");
}

TEST_F(FolderTest, MeshesThatNoSolverCanUseAreWrittenOnRequestOnly) {
  MeshArguments arguments;
  arguments.output = (folder / "mesh.vtu").string();
  arguments.quiet = true;
  const auto make = [](Stages&, report::MeshRun& run) {
    TetMesh& mesh = run.result.mesh;
    const auto [plc, box] = testing::meshed_box(2);
    mesh = box;
    std::swap(mesh.tets.front()[0], mesh.tets.front()[1]);
    run.check = check(mesh, plc);
  };
  process::Process process;
  try {
    make_and_write(process, arguments, make);
    ADD_FAILURE() << "the mesh was written";
  } catch (const process::Stopped& stopped) {
    EXPECT_EQ(stopped.code, ExitCode::guarantee_missed);
    EXPECT_NE(std::string(stopped.what()).find("inverted"), std::string::npos) << stopped.what();
  }
  EXPECT_EQ(entries(), 0U);
  arguments.keep_invalid = true;
  EXPECT_EQ(make_and_write(process, arguments, make), ExitCode::guarantee_missed);
  EXPECT_EQ(entries(), 1U);
}

}  // namespace
}  // namespace collarmesh::cli::parts_test
