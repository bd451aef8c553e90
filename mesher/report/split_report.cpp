#include "report/split_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/listed.h"

namespace collarmesh::report {

using Json = nlohmann::ordered_json;

std::string split_text(const SplitReport& report) {
  std::string text;
  for (std::size_t k = 0; k < std::min(listed, report.patches.size()); ++k) {
    const SplitReport::Patch& p = report.patches[k];
    if (p.faces > 0)
      text += fmt::format(
          "  split: {} into patches {} and {}, {} triangles each, area {:.6g}, at ({:.6g}, {:.6g}, {:.6g})\n",
          p.name, p.sides.minus, p.sides.plus, p.faces, p.area, p.where.x, p.where.y, p.where.z);
    if (p.closed > 0)
      text += fmt::format(
          "  not split: {} triangles of {}, which cannot open because all their corners are on the front of "
          "the crack, for example at ({:.6g}, {:.6g}, {:.6g})\n",
          p.closed, p.name, p.closed_at.x, p.closed_at.y, p.closed_at.z);
  }
  if (report.patches.size() > listed)
    text += fmt::format("  ... and {} more patches (--report lists all)\n", report.patches.size() - listed);
  text += fmt::format("  {} nodes were split ({} at junctions), {} nodes are new, {} on fronts stay single\n",
                      report.split_nodes, report.junction_nodes, report.new_nodes, report.front_nodes);
  if (!report.interfaces.prisms.empty())
    text += fmt::format("  {} cohesive elements\n", report.interfaces.prisms.size());
  return text;
}

Json split_json(const SplitReport& report) {
  Json patches = Json::array();
  for (const SplitReport::Patch& p : report.patches)
    patches.push_back({{"tag", p.tag},
                       {"name", p.name},
                       {"minus", p.faces > 0 ? Json(p.sides.minus) : Json(nullptr)},
                       {"plus", p.faces > 0 ? Json(p.sides.plus) : Json(nullptr)},
                       {"triangles", p.faces},
                       {"area", p.area},
                       {"where", {p.where.x, p.where.y, p.where.z}},
                       {"closed_triangles", p.closed},
                       {"closed_at", {p.closed_at.x, p.closed_at.y, p.closed_at.z}}});
  return {{"patches", std::move(patches)},           {"split_nodes", report.split_nodes},
          {"junction_nodes", report.junction_nodes}, {"new_nodes", report.new_nodes},
          {"front_nodes", report.front_nodes},       {"cohesive_elements", report.interfaces.prisms.size()}};
}

}  // namespace collarmesh::report
