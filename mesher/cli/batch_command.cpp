#include "batch_command.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "collarmesh/error.h"

namespace collarmesh::cli {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// A folder that is removed when the batch ends, for reports that the user did not ask for.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "collarmesh-batch-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr)
      throw WriteError(fmt::format("{}: cannot be made; is the disk full?", path_));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path file(const char* name) const { return fs::path(path_) / name; }

 private:
  std::string path_;
};

/// The outcome of meshing one part, with the contents of its report.
struct Result {
  std::string input;
  ExitCode code = ExitCode::cancelled;
  Json report;
};

ExitCode run_apart(process::Supervisor& supervisor, const MeshArguments& part,
                   const std::function<ExitCode(const MeshArguments&)>& run) {
  std::fflush(nullptr);  // if not flushed, both processes would write the buffered text
  const pid_t made = fork();
  if (made == 0) std::exit(static_cast<int>(run(part)));
  if (made < 0) return run(part);
  supervisor.child = made;
  int status = 0;
  while (waitpid(made, &status, 0) < 0 && errno == EINTR) {
  }
  supervisor.child = 0;
  if (WIFEXITED(status)) return static_cast<ExitCode>(WEXITSTATUS(status));
  return supervisor.asked_to_stop ? ExitCode::cancelled : ExitCode::internal_error;
}

Json read_report(const fs::path& path) {
  std::ifstream file(path);
  return Json::parse(file, nullptr, false);
}

bool is_meshed(ExitCode code) { return code == ExitCode::success || code == ExitCode::guarantee_missed; }

std::string words_of(ExitCode code) {
  switch (code) {
    case ExitCode::success: return "every guarantee holds";
    case ExitCode::guarantee_missed: return "a guarantee is missed";
    case ExitCode::unreadable: return "cannot be read";
    case ExitCode::invalid_complex: return "not a valid complex";
    case ExitCode::budget_hit: return "a budget was hit";
    case ExitCode::cancelled: return "cancelled";
    case ExitCode::usage: return "usage";
    case ExitCode::cannot_write: return "cannot be written";
    case ExitCode::internal_error: return "internal error";
  }
  return "unknown";
}

/// Returns whether a mesh was written: a mesh that no solver can use is not written.
bool has_mesh(const Result& result) {
  return is_meshed(result.code) && result.report.is_object() && result.report.contains("mesh");
}

std::string row_of(const Result& result, std::size_t width) {
  std::string text = fmt::format("{:{}}  ", result.input, width);
  if (has_mesh(result)) {
    const Json &mesh = result.report["mesh"], &seconds = result.report["seconds"];
    text += fmt::format("{:>9}  {:>8.2f}  {:>8.2f}  {:>8.2f}  ", mesh["tets"].get<std::size_t>(),
                        mesh["min_dihedral"].get<double>(), mesh["max_dihedral"].get<double>(),
                        seconds["total"].get<double>());
  } else {
    text += fmt::format("{:>9}  {:>8}  {:>8}  {:>8}  ", "-", "-", "-", "-");
  }
  const bool unusable = is_meshed(result.code) && !has_mesh(result);
  return text + (unusable ? "has no usable mesh" : words_of(result.code)) + "\n";
}

std::string table_of(const std::vector<Result>& results) {
  std::size_t width = 4;
  for (const Result& result : results) width = std::max(width, result.input.size());
  std::string text = fmt::format("{:{}}  {:>9}  {:>8}  {:>8}  {:>8}  {}\n", "part", width, "tets", "smallest",
                                 "largest", "seconds", "result");
  for (const Result& result : results) text += row_of(result, width);
  const auto meshed = std::ranges::count_if(results, has_mesh);
  return text +
         fmt::format("{} of {} parts have a mesh; angles are dihedral, in degrees\n", meshed, results.size());
}

ExitCode code_of(const std::vector<Result>& results) {
  const auto failed =
      std::find_if(results.begin(), results.end(), [](const Result& r) { return !is_meshed(r.code); });
  if (failed != results.end()) return failed->code;
  const bool missed = std::any_of(results.begin(), results.end(),
                                  [](const Result& r) { return r.code == ExitCode::guarantee_missed; });
  return missed ? ExitCode::guarantee_missed : ExitCode::success;
}

}  // namespace

MeshArguments part_of_batch(const MeshArguments& batch, const std::string& input) {
  MeshArguments part = batch;
  const fs::path place = fs::path(batch.batch) / fs::path(input).stem();
  part.batch.clear();
  part.inputs = {input};
  part.output = place.string() + (batch.output_format.empty() ? ".vtu" : batch.output_format);
  for (std::string& report : part.reports) report.insert(0, place.string() + ".");
  return part;
}

std::string parts_of_one_name(const MeshArguments& batch) {
  std::map<std::string, std::string> known;
  for (const std::string& input : batch.inputs)
    if (const auto [before, added] = known.emplace(part_of_batch(batch, input).output, input); !added)
      return fmt::format("{} and {}", before->second, input);
  return {};
}

ExitCode batch_command(process::Process& process, const MeshArguments& batch,
                       const std::function<ExitCode(const MeshArguments& part)>& run) {
  std::error_code error;
  fs::create_directories(batch.batch, error);
  if (error)
    throw WriteError(
        fmt::format("{}: cannot be made ({}); choose another folder", batch.batch, error.message()));
  process.pass_signals_on();
  const TemporaryFolder folder;
  std::vector<Result> results;
  for (const std::string& input : batch.inputs) {
    results.push_back({input, ExitCode::cancelled, {}});
    if (process.supervisor.asked_to_stop) continue;
    if (!batch.quiet) process.console.tell("{}:\n", input);
    MeshArguments part = part_of_batch(batch, input);
    const fs::path report = folder.file("report.json");
    part.reports.push_back(report.string());
    results.back().code = run_apart(process.supervisor, part, run);
    results.back().report = read_report(report);
    fs::remove(report, error);
  }
  process.console.print_result(table_of(results));
  return process.supervisor.asked_to_stop ? ExitCode::cancelled : code_of(results);
}

}  // namespace collarmesh::cli
