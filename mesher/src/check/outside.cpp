// Features of the complex that lie outside all regions: the mesh does not have them.
#include <algorithm>

#include "check/subject.h"

namespace collarmesh::checks {

bool patch_is_outside(const Subject& subject, Index patch) {
  const auto& regions = subject.plc.patches[patch].regions;
  return regions[0] == 0 && regions[1] == 0;
}

bool curve_is_outside(const Subject& subject, Index curve) {
  const Plc::Curve& c = subject.plc.curves[curve];
  if (!c.patches.empty())
    return std::all_of(c.patches.begin(), c.patches.end(),
                       [&](Index p) { return patch_is_outside(subject, p); });
  const std::size_t i = c.points.size() / 2;
  const Point &a = subject.plc.points[c.points[i - 1]], &b = subject.plc.points[c.points[i]];
  return subject.regions->region_at(0.5 * (a + b)) == 0;
}

bool vertex_is_outside(const Subject& subject, Index vertex) {
  const Plc::Vertex& v = subject.plc.vertices[vertex];
  if (v.patches.empty() && v.curves.empty())
    return subject.regions->region_at(subject.plc.points[v.point]) == 0;
  return std::all_of(v.patches.begin(), v.patches.end(),
                     [&](Index p) { return patch_is_outside(subject, p); }) &&
         std::all_of(v.curves.begin(), v.curves.end(), [&](Index c) { return curve_is_outside(subject, c); });
}

}  // namespace collarmesh::checks
