// Features of the complex outside all regions, which the mesh does not have.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

bool patch_is_outside(const MeshToCheck& to_check, Index patch) {
  const auto& regions = to_check.plc.patches[patch].regions;
  return regions[0] == 0 && regions[1] == 0;
}

bool curve_is_outside(const MeshToCheck& to_check, Index curve) {
  const Plc::Curve& c = to_check.plc.curves[curve];
  if (!c.patches.empty())
    return std::all_of(c.patches.begin(), c.patches.end(),
                       [&](Index p) { return patch_is_outside(to_check, p); });
  const std::size_t i = c.points.size() / 2;
  const Point &a = to_check.plc.points[c.points[i - 1]], &b = to_check.plc.points[c.points[i]];
  return to_check.regions->region_at(0.5 * (a + b)) == 0;
}

bool vertex_is_outside(const MeshToCheck& to_check, Index vertex) {
  const Plc::Vertex& v = to_check.plc.vertices[vertex];
  if (v.patches.empty() && v.curves.empty())
    return to_check.regions->region_at(to_check.plc.points[v.point]) == 0;
  return std::all_of(v.patches.begin(), v.patches.end(),
                     [&](Index p) { return patch_is_outside(to_check, p); }) &&
         std::all_of(v.curves.begin(), v.curves.end(),
                     [&](Index c) { return curve_is_outside(to_check, c); });
}

void warn_of_features_outside(const MeshToCheck& to_check, CheckReport& report) {
  const Plc& plc = to_check.plc;
  const auto warn = [&](std::size_t count, std::string_view kinds, std::string_view kind, Index first,
                        Tag tag, const Point& where) {
    report.warnings.push_back(
        fmt::format("{} outside of every region are not meshed: {} in all, of which the first is {} {} (tag "
                    "{}) at {}. Move them into a region, or remove them.",
                    kinds, count, kind, first, tag, At{where}));
  };
  std::size_t count = 0;
  Index first = none;
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (plc.curves[c].patches.empty() && curve_is_outside(to_check, c) && count++ == 0) first = c;
  if (count > 0)
    warn(count, "Curves", "curve", first, plc.curves[first].tag,
         plc.points[plc.curves[first].points.front()]);
  count = 0;
  for (Index v = 0; v < plc.vertices.size(); ++v)
    if (plc.vertices[v].patches.empty() && plc.vertices[v].curves.empty() && vertex_is_outside(to_check, v) &&
        count++ == 0)
      first = v;
  if (count > 0)
    warn(count, "Vertices", "vertex", first, plc.vertices[first].tag, plc.points[plc.vertices[first].point]);
}

}  // namespace collarmesh::checks
