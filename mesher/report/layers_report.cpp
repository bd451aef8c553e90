#include "report/layers_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/listed.h"

namespace collarmesh::report {

using Json = nlohmann::ordered_json;

namespace {

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

}  // namespace

std::string layers_text(const LayersReport& report) {
  std::string text;
  for (std::size_t k = 0; k < std::min(listed, report.patches.size()); ++k) {
    const LayersReport::Patch& p = report.patches[k];
    text += fmt::format("  layers: {} covered to {:.1f}%, mean thickness {:.4g}, asked for {:.4g}\n", p.name,
                        percent(p.covered, p.area), p.mean, p.asked);
  }
  if (report.patches.size() > listed)
    text += fmt::format("  ... and {} more faces (--report lists all)\n", report.patches.size() - listed);
  for (const LayersReport::Reduction& r : report.reductions)
    text += fmt::format(
        "  layers lower than asked for at {} nodes, down to {:.0f}% at ({:.6g}, {:.6g}, {:.6g}): {}\n",
        r.nodes, 100 * r.smallest, r.where.x, r.where.y, r.where.z, r.why);
  text += fmt::format("  {} prisms, {} pyramids and {} tets in layers cover {:.1f}% of the walls\n",
                      report.prisms, report.pyramids, report.tets, 100 * report.coverage());
  return text;
}

Json layers_json(const LayersReport& report) {
  Json patches = Json::array(), reductions = Json::array();
  for (const LayersReport::Patch& p : report.patches)
    patches.push_back({{"tag", p.tag},
                       {"name", p.name},
                       {"area", p.area},
                       {"covered", p.covered},
                       {"thickness_asked", p.asked},
                       {"thickness_mean", p.mean},
                       {"area_by_tenth_of_thickness", p.histogram}});
  for (const LayersReport::Reduction& r : report.reductions)
    reductions.push_back({{"why", r.why},
                          {"nodes", r.nodes},
                          {"smallest_share", r.smallest},
                          {"where", {r.where.x, r.where.y, r.where.z}}});
  return {{"coverage", report.coverage()},       {"patches", std::move(patches)},
          {"reductions", std::move(reductions)}, {"prisms", report.prisms},
          {"pyramids", report.pyramids},         {"tets", report.tets},
          {"largest_step", report.largest_step}};
}

}  // namespace collarmesh::report
