#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "collarmesh/plc_builder.h"
#include "facets/faults.h"
#include "plc/angles.h"

namespace collarmesh {

namespace {

// Angles count as below the threshold if they are below it by more than this (degrees).
constexpr double angle_rounding = 1e-6;

std::vector<Crease> below(std::vector<Crease> angles, double threshold) {
  std::erase_if(angles, [&](const Crease& c) { return c.angle >= threshold - angle_rounding; });
  std::ranges::stable_sort(angles, {}, &Crease::angle);
  return angles;
}

double shortest_segment(const Plc& plc) {
  double shortest = INFINITY;
  for (const Plc::Curve& curve : plc.curves) {
    if (curve.closed || curve.ends[0] == curve.ends[1]) continue;
    shortest =
        std::min(shortest, distance(plc.points[curve.points.front()], plc.points[curve.points.back()]));
  }
  return std::isfinite(shortest) ? shortest : 0;
}

std::string name(Index index, Tag tag) {
  return tag == 0 ? fmt::format("{}", index) : fmt::format("{} (tag {})", index, tag);
}
std::string patch_name(const Plc& plc, Index p) { return name(p, plc.patches[p].tag); }
std::string curve_name(const Plc& plc, Index c) { return name(c, plc.curves[c].tag); }

std::string meet(const char* first_kind, const std::string& first, const char* second_kind,
                 const std::string& second) {
  const bool alike = std::string_view(first_kind).substr(1) == std::string_view(second_kind).substr(1);
  if (alike && first == second) return fmt::format("{} {} meets itself", first_kind, first);
  return fmt::format("{} {} meets {} {}", first_kind, first, second_kind, second);
}

}  // namespace

std::vector<Crease> find_creases(const Plc& plc, double threshold) {
  return below(plc::measure_angles(plc), threshold);
}

PlcSummary summarize(const Plc& plc, double crease_threshold) {
  PlcSummary summary;
  summary.points = static_cast<Index>(plc.points.size());
  summary.vertices = static_cast<Index>(plc.vertices.size());
  summary.curves = static_cast<Index>(plc.curves.size());
  for (const Plc::Curve& c : plc.curves) summary.straight_curves += c.straight ? 1 : 0;
  summary.patches = static_cast<Index>(plc.patches.size());
  for (const Plc::Patch& p : plc.patches) summary.planar_patches += p.planar ? 1 : 0;
  summary.triangles = static_cast<Index>(plc.triangles.size());
  summary.regions = static_cast<Index>(plc.regions.size()) - 1;
  summary.diagonal = plc.bounds.diagonal();
  summary.shortest_segment = shortest_segment(plc);
  if (summary.shortest_segment > 0) summary.spread = summary.diagonal / summary.shortest_segment;
  summary.largest_deviation = plc.largest_deviation;
  std::vector<Crease> angles = plc::measure_angles(plc);
  for (const Crease& c : angles) summary.smallest_angle = std::min(summary.smallest_angle, c.angle);
  summary.creases = below(std::move(angles), crease_threshold);
  return summary;
}

std::string describe(const Plc& plc, const Crease& crease) {
  const auto [f, g] = crease.features;
  const std::string where = facets::text(crease.where);
  switch (crease.kind) {
    case Crease::Kind::facets:
      return fmt::format("{} along {} at {:.2f} degrees near {}.",
                         meet("Patch", patch_name(plc, f), "patch", patch_name(plc, g)),
                         "curve " + curve_name(plc, crease.curve), crease.angle, where);
    case Crease::Kind::segments:
      return fmt::format("{} at {:.2f} degrees in {}.",
                         meet("Curve", curve_name(plc, f), "curve", curve_name(plc, g)), crease.angle, where);
    case Crease::Kind::segment_and_facet:
      return fmt::format("{} at {:.2f} degrees in {}.",
                         meet("Curve", curve_name(plc, f), "patch", patch_name(plc, g)), crease.angle, where);
    case Crease::Kind::facets_in_vertex:
      return fmt::format("{} only in the point {}, at {:.2f} degrees.",
                         meet("Patch", patch_name(plc, f), "patch", patch_name(plc, g)), where, crease.angle);
    case Crease::Kind::patch_fold:
      return fmt::format("Patch {} folds to {:.2f} degrees in {}.", patch_name(plc, f), crease.angle, where);
  }
  return {};
}

}  // namespace collarmesh
