#include "shells/surface_sizes.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace collarmesh::shells {

namespace {

// Gradation if none is given. A smallest angle of 20 degrees permits about this much.
constexpr double default_gradation = 0.8;

}  // namespace

SurfaceSizes::SurfaceSizes(const Plc& plc, const CurvePaths& paths, const MeshOptions& options)
    : plc_(plc),
      paths_(paths),
      sizing_(plc, options, Frame()),
      gradation_(options.gradation > 0 ? options.gradation : default_gradation),
      gradation_is_given_(options.gradation > 0),
      at_vertex_(plc.vertices.size(), INFINITY) {
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    at_vertex_[v] = asked_at_vertex(v);
    for (const Index curve : plc.vertices[v].curves)
      at_vertex_[v] = std::min(at_vertex_[v], paths.length(curve));
  }
}

double SurfaceSizes::asked_at_vertex(Index vertex) const {
  const Point& p = plc_.points[plc_.vertices[vertex].point];
  double size = INFINITY;
  for (const Index patch : plc_.vertices[vertex].patches)
    size = std::min(size, sizing_.feature_size(2, patch, p));
  for (const Index curve : plc_.vertices[vertex].curves) {
    const double end = plc_.curves[curve].ends[0] == vertex ? 0 : paths_.length(curve);
    size = std::min(size, asked_on_curve(curve, end));
  }
  return size;
}

double SurfaceSizes::asked_on_curve(Index curve, double parameter) const {
  const std::size_t segment = paths_.segment(curve, parameter);
  return sizing_.curve_size(curve, segment, segment, paths_.point(curve, parameter));
}

double SurfaceSizes::on_curve(Index curve, double parameter) const {
  double size = asked_on_curve(curve, parameter);
  const auto& [first, last] = plc_.curves[curve].ends;
  if (first != none) size = std::min(size, at_vertex_[first] + gradation_ * parameter);
  if (last != none)
    size = std::min(size, at_vertex_[last] + gradation_ * std::max(0.0, paths_.length(curve) - parameter));
  return size;
}

void grade(SurfaceComplex& complex, double gradation, double SurfaceComplex::Vertex::*sizes) {
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index v = 0; v < complex.vertices.size(); ++v)
    if (!complex.vertices[v].triangles.empty()) queue.emplace(complex.vertices[v].*sizes, v);
  while (!queue.empty()) {
    const auto [size, v] = queue.top();
    queue.pop();
    if (size > complex.vertices[v].*sizes) continue;
    for (const Index n : complex.neighbours(v)) {
      auto& other = complex.vertices[n];
      const double most = size + gradation * distance(complex.vertices[v].point, other.point);
      if (most >= other.*sizes) continue;
      other.*sizes = most;
      queue.emplace(most, n);
    }
  }
}

}  // namespace collarmesh::shells
