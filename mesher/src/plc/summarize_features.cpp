#include <map>

#include "collarmesh/plc_builder.h"
#include "common/segments.h"

namespace collarmesh {

namespace {

template <class Summary>
std::vector<Summary> named(std::map<Tag, Summary> by_tag, std::size_t dimension, const TagNames& names) {
  std::vector<Summary> summaries;
  for (auto& [tag, summary] : by_tag) {
    if (const std::string* name = names.find(dimension, tag)) summary.name = *name;
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace

std::vector<PatchSummary> summarize_patches(const Plc& plc) {
  std::map<Tag, PatchSummary> by_tag;
  for (const Plc::Patch& patch : plc.patches) {
    PatchSummary& summary = by_tag[patch.tag];
    summary.tag = patch.tag;
    summary.planar = summary.planar && patch.planar;
    double largest = -1;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& [i, j, k] = plc.triangles[t].points;
      const Point &a = plc.points[i], &b = plc.points[j], &c = plc.points[k];
      const double area = 0.5 * norm(cross(b - a, c - a));
      summary.area += area;
      if (summary.count > 0 || area <= largest) continue;
      largest = area;
      summary.where = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
    }
    ++summary.count;
  }
  return named(std::move(by_tag), 2, plc.names);
}

std::vector<CurveSummary> summarize_curves(const Plc& plc) {
  std::map<Tag, CurveSummary> by_tag;
  for (const Plc::Curve& curve : plc.curves) {
    CurveSummary& summary = by_tag[curve.tag];
    summary.tag = curve.tag;
    summary.straight = summary.straight && curve.straight;
    double longest = -1;
    visit_segments(curve, [&](Index from, Index to) {
      const Point &a = plc.points[from], &b = plc.points[to];
      const double length = distance(a, b);
      summary.length += length;
      if (summary.count > 0 || length <= longest) return;
      longest = length;
      summary.where = 0.5 * (a + b);
    });
    ++summary.count;
  }
  return named(std::move(by_tag), 1, plc.names);
}

}  // namespace collarmesh
