#include "failure_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

#include "common/stopwatch.h"
#include "common/xml_text.h"
#include "io/file_writer.h"
#include "report/html_report.h"
#include "report/json_text.h"
#include "report/options_json.h"

namespace collarmesh::cli {

namespace {

using Json = nlohmann::ordered_json;

/// The data of the command that are known before anything fails.
struct Command {
  std::vector<std::string> reports;
  Json json;
  Stopwatch stopwatch;
};
const char* status_of(ExitCode code) {
  switch (code) {
    case ExitCode::success: return "complete";
    case ExitCode::internal_error: return "internal_error";
    case ExitCode::usage: return "usage";
    case ExitCode::unreadable: return "unreadable";
    case ExitCode::invalid_complex: return "invalid_complex";
    case ExitCode::budget_hit: return "budget_hit";
    case ExitCode::cancelled: return "cancelled";
    case ExitCode::guarantee_missed: return "guarantee_missed";
    case ExitCode::cannot_write: return "cannot_write";
  }
  return "unknown";
}

Json failure_json(const Command& command, const process::StageReached& reached, ExitCode code,
                  std::string_view message, const PlcError* error) {
  Json json = command.json;
  json["status"] = status_of(code);
  json["exit_code"] = static_cast<int>(code);
  json["message"] = message;
  json["guarantees_hold"] = false;
  json["stage"] = reached.stage;
  json["reached"] = {{"vertices", reached.vertices}, {"tets", reached.tets}};
  Json faults = Json::array();
  if (error != nullptr)
    for (const PlcFault& fault : error->faults)
      faults.push_back(
          {{"message", fault.message}, {"where", {fault.where.x, fault.where.y, fault.where.z}}});
  json["faults"] = std::move(faults);
  json["seconds"] = {{"total", command.stopwatch.seconds()}};
  return json;
}

/// Returns a page that tells why there is no mesh.
std::string failure_page(const Json& json) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>no mesh</title></head><body>\n"
      "<h1>{}</h1>\n<p><strong>No mesh was written</strong> ({}, exit code {}, in the stage "
      "{}).</p>\n<p>{}</p>\n"
      "<pre>{}</pre>\n</body></html>\n",
      xml_text(report::json_text(json["inputs"])), json["status"].get<std::string>(),
      json["exit_code"].get<int>(), xml_text(json["stage"].get<std::string>()),
      xml_text(json["message"].get<std::string>()), xml_text(report::json_text(json, 1)));
}

/// Writes a report. If the path is a symbolic link, writes the file that the link points to. Writes nothing
/// if another kind of file than a regular one is there: it may be the reason why the command failed.
void write(const std::string& path, const Json& json) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path place = fs::is_symlink(path, error) ? fs::weakly_canonical(path) : fs::path(path);
  if (fs::exists(fs::symlink_status(place)) && !fs::is_regular_file(place)) return;
  io::FileWriter file(place.string());
  file << (report::is_html(path) ? failure_page(json) : report::json_text(json, 1) + '\n');
  file.commit();
}

}  // namespace

void report_failures_of(process::Process& process, const Arguments& arguments) {
  const MeshArguments* const a = std::visit(
      []<class A>(const A& given) -> const MeshArguments* {
        if constexpr (std::is_base_of_v<MeshArguments, A>) return &given;
        return nullptr;
      },
      arguments);
  if (a == nullptr || a->reports.empty()) return process.reports.on_failure({});
  process.reports.on_failure([&process, command = Command{a->reports,
                                                          {{"program", "collarmesh"},
                                                           {"version", COLLARMESH_VERSION},
                                                           {"inputs", a->inputs},
                                                           {"output", a->output},
                                                           {"options", report::options_json(*a)}},
                                                          Stopwatch()}](
                                 ExitCode code, std::string_view message, const PlcError* faults) {
    const Json json = failure_json(command, process.interrupts.stage_reached(), code, message, faults);
    for (const std::string& path : command.reports) write(path, json);
  });
}

}  // namespace collarmesh::cli
