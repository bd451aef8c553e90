#include "report/html_report.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "io/base64.h"
#include "io/zlib_block.h"
#include "report/html_report_page.h"
#include "report/json_text.h"

namespace collarmesh::report {

namespace {

using Json = nlohmann::ordered_json;

template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

/// Returns JSON as text for a script element. It contains no `<`, which could end the script.
std::string json_in_page(const Json& json) {
  std::string text = json_text(json), safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

std::string packed(const std::string& bytes) { return io::base64_encode(io::zlib_pack(bytes, 6)); }

std::string packed_cells(const ShownMesh& shown) {
  std::string data;
  append(data, shown.points);
  append(data, shown.tets);
  append(data, shown.faces);
  append(data, shown.region);
  append(data, shown.marks);
  return packed(data);
}

Json trace_json(const std::vector<ShownStep>& trace) {
  Json steps = Json::array();
  for (const ShownStep& step : trace) {
    std::string extras;
    append(extras, step.lines);
    append(extras, step.balls);
    steps.push_back({{"stage", step.stage},
                     {"detail", step.detail},
                     {"complete", step.cells.complete},
                     {"points", step.cells.points.size() / 3},
                     {"tets", step.cells.tets.size() / 4},
                     {"faces", step.cells.faces.size() / 4},
                     {"segments", step.lines.size() / 6},
                     {"balls", step.balls.size() / 4},
                     {"data", packed_cells(step.cells)},
                     {"extras", packed(extras)}});
  }
  return steps;
}

Json shown_json(const ShownMesh& shown) {
  const auto place = [](const Point& p) { return Json::array({p.x, p.y, p.z}); };
  Json worst = Json::array();
  for (const ShownMesh::ShownWorst& w : shown.worst)
    worst.push_back(
        {{"tet", w.tet}, {"smallest", w.smallest}, {"largest", w.largest}, {"where", place(w.where)}});
  return {{"complete", shown.complete},        {"centre", place(shown.centre)},
          {"points", shown.points.size() / 3}, {"tets", shown.tets.size() / 4},
          {"faces", shown.faces.size() / 4},   {"face_tags", shown.face_tags},
          {"worst", std::move(worst)}};
}

/// Removes the lists of node pairs, because pages show only how many pairs there are.
Json without_node_pairs(Json report) {
  if (const auto periodic = report.find("periodic"); periodic != report.end() && periodic->is_object())
    for (Json& pair : (*periodic)["pairs"]) pair.erase("node_pairs");
  return report;
}

}  // namespace

std::string html_report(const Json& report, const ShownMesh& shown, const std::vector<ShownStep>& trace) {
  std::string page;
  std::string_view rest = html_report_page;
  const auto fill = [&](std::string_view mark, const std::string& text) {
    const std::size_t at = rest.find(mark);
    page += rest.substr(0, at);
    page += text;
    rest.remove_prefix(at + mark.size());
  };
  fill("<!--report-->", json_in_page(without_node_pairs(report)));
  fill("<!--shown-->", json_in_page(shown_json(shown)));
  fill("<!--data-->", packed_cells(shown));
  fill("<!--trace-->", json_in_page(trace_json(trace)));
  return page.append(rest);
}

bool is_html(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".html" || extension == ".htm";
}

}  // namespace collarmesh::report
