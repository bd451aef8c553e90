#include "report/periodic_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace collarmesh::report {

using Json = nlohmann::ordered_json;

namespace {

Json vector_json(const Vector& v) { return Json::array({v.x, v.y, v.z}); }

void add_map(Json& json, const TetMesh::PeriodicFaces& faces) {
  json["first"] = faces.first;
  json["second"] = faces.second;
  json["rows"] = Json::array();
  for (const Vector& row : faces.motion.rows) json["rows"].push_back(vector_json(row));
  json["shift"] = vector_json(faces.motion.shift);
  json["node_pairs"] = faces.nodes;
}

}  // namespace

std::string periodic_text(const PeriodicReport& report) {
  std::string text;
  for (const PeriodicReport::Pair& p : report.pairs)
    text += fmt::format("  periodic {}: {} nodes, {} triangles map onto their images; largest gap {:.2g}\n",
                        p.text, p.nodes, p.faces, p.largest_gap);
  const std::size_t changes = report.inserted_nodes + report.removed_nodes + report.turned_edges;
  if (changes > 0)
    text +=
        fmt::format("  to make both sides alike, {} nodes were inserted, {} removed, and {} edges flipped\n",
                    report.inserted_nodes, report.removed_nodes, report.turned_edges);
  return text;
}

Json periodic_json(const PeriodicReport& report, const TetMesh& mesh) {
  Json pairs = Json::array();
  for (std::size_t k = 0; k < report.pairs.size(); ++k) {
    const PeriodicReport::Pair& p = report.pairs[k];
    Json pair{{"text", p.text},
              {"nodes", p.nodes},
              {"edges", p.edges},
              {"triangles", p.faces},
              {"largest_gap", p.largest_gap}};
    if (k < mesh.periodic.size()) add_map(pair, mesh.periodic[k]);
    pairs.push_back(std::move(pair));
  }
  return {{"pairs", std::move(pairs)},
          {"inserted_nodes", report.inserted_nodes},
          {"removed_nodes", report.removed_nodes},
          {"turned_edges", report.turned_edges}};
}

}  // namespace collarmesh::report
