#include "shells/sharp_corners.h"

#include <algorithm>
#include <utility>

#include "shells/curve_division.h"
#include "shells/triangle_shape.h"

namespace collarmesh::shells {

namespace {

// Corners are sharp below this angle, degrees. A wider corner has room for two good triangles.
constexpr double sharp = 2 * least_angle;

unsigned end_of(const SurfaceComplex::Edge& edge, Index vertex) {
  return edge.ends[0] == vertex && edge.at[0] == 0 ? 0 : 1;
}

/// The triangles of a patch around a vertex between two edges of curves.
struct Fan {
  double angle = 0;  // degrees
  std::vector<Index> edges;
};

Fan fan_from(const SurfaceComplex& complex, Index vertex, Index first, std::vector<Index>& seen) {
  Fan fan;
  std::vector<Index> stack{first};
  seen.push_back(first);
  while (!stack.empty()) {
    const Index t = stack.back();
    stack.pop_back();
    const auto& c = complex.triangles[t].corners;
    std::array<Vector, 2> sides;
    unsigned count = 0;
    for (const Index other : c) {
      if (other == vertex) continue;
      sides[count++] = complex.vertices[other].point - complex.vertices[vertex].point;
      if (const Index edge = complex.edge_at(vertex, other); edge != none) {
        fan.edges.push_back(edge);
        continue;
      }
      const Index next = complex.across(t, vertex, other);
      if (next == none || std::find(seen.begin(), seen.end(), next) != seen.end()) continue;
      seen.push_back(next);
      stack.push_back(next);
    }
    fan.angle += angle_of(dot(sides[0], sides[1]), norm(cross(sides[0], sides[1])));
  }
  return fan;
}

}  // namespace

SharpCorners::SharpCorners(const SurfaceComplex& complex, const Plc& plc, const CurvePaths& paths,
                           const SurfaceSizes& sizes, const ChordLimits& limits)
    : tips_(plc.curves.size(), {0, 0}) {
  std::vector<Corner> corners;
  for (Index v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].feature.dimension != 0) continue;
    Corner corner = find(complex, v);
    for (const auto& [curve, end] : corner.ends) tips_[curve][end] = 1;
    if (!corner.ends.empty()) corners.push_back(std::move(corner));
  }
  std::vector<double> lengths;
  lengths.reserve(corners.size());
  for (const Corner& corner : corners) lengths.push_back(tip_length(plc, paths, sizes, limits, corner));
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (const auto& [curve, end] : corners[i].ends) tips_[curve][end] = lengths[i];
}

SharpCorners::Corner SharpCorners::find(const SurfaceComplex& complex, Index vertex) const {
  Corner corner{complex.vertices[vertex].feature.feature, {}, {}};
  std::vector<Index> seen;
  for (const Index t : complex.vertices[vertex].triangles) {
    if (std::find(seen.begin(), seen.end(), t) != seen.end()) continue;
    const Fan fan = fan_from(complex, vertex, t, seen);
    if (fan.angle >= sharp || fan.edges.size() != 2 || fan.edges[0] == fan.edges[1]) continue;
    for (const Index edge : fan.edges)
      corner.ends.push_back({complex.edges[edge].curve, end_of(complex.edges[edge], vertex)});
    corner.patches.push_back(complex.triangles[t].patch);
  }
  return corner;
}

/// Returns the length of the tips at a corner: the target edge length there, or less if a curve is short, if
/// the rest of a curve would be much shorter than its tip, or if a tip would be too far from its curve.
/// Ignores limits across the corner's own patches, because a triangle closes the corner.
double SharpCorners::tip_length(const Plc& plc, const CurvePaths& paths, const SurfaceSizes& sizes,
                                const ChordLimits& limits, const Corner& corner) const {
  constexpr unsigned most_steps = 40;
  constexpr double least_rest = 0.4, same = 1e-6;
  double tip = sizes.at_vertex(corner.vertex);
  const SagLimit limit = [&](Index point) { return limits.at_point(point, corner.patches); };
  const auto divide = [&](const End& end) {
    const double length = paths.length(end.curve), rest = length - tip;
    const double most = tips_[end.curve][0] > 0 && tips_[end.curve][1] > 0
                            ? length / 3
                            : length / least_edge_count(plc, end.curve);
    if (tip > most * (1 + same)) return tip = most, true;
    if (rest > same * length && rest < least_rest * tip) return tip = length / 2, true;
    const double from = end.end == 0 ? 0 : rest;
    if (sag_between(plc, paths, limit, end.curve, from, from + tip) > 1) return tip /= 2, true;
    return false;
  };
  for (unsigned step = 0; step < most_steps; ++step)
    if (std::none_of(corner.ends.begin(), corner.ends.end(), divide)) break;
  return tip;
}

void SharpCorners::mark(SurfaceComplex& complex) const {
  for (auto& edge : complex.edges) {
    if (!edge.alive()) continue;
    for (const Index v : edge.ends)
      if (complex.vertices[v].feature.dimension == 0 && tips_[edge.curve][end_of(edge, v)] > 0) edge.tip = v;
    if (edge.tip == none) continue;
    for (const Index v : edge.ends)
      complex.vertices[v].size = std::min(complex.vertices[v].size, edge.at[1] - edge.at[0]);
  }
}

}  // namespace collarmesh::shells
