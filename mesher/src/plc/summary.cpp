#include "collarmesh/plc_builder.h"

namespace collarmesh {

std::vector<Crease> find_creases(const Plc&, double) { return {}; }

PlcSummary summarize(const Plc& plc, double) {
  PlcSummary s;
  s.points = static_cast<Index>(plc.points.size());
  s.vertices = static_cast<Index>(plc.vertices.size());
  s.curves = static_cast<Index>(plc.curves.size());
  s.patches = static_cast<Index>(plc.patches.size());
  s.triangles = static_cast<Index>(plc.triangles.size());
  s.regions = static_cast<Index>(plc.regions.size()) - 1;
  s.diagonal = plc.bounds.diagonal();
  s.largest_deviation = plc.largest_deviation;
  for (const auto& c : plc.curves) s.straight_curves += c.straight;
  for (const auto& p : plc.patches) s.planar_patches += p.planar;
  return s;
}

std::string describe(const Plc&, const Crease&) { return {}; }

}  // namespace collarmesh
