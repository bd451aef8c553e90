#include "refine/graded_sizes.h"

#include <cassert>
#include <queue>

namespace collarmesh {

namespace {

constexpr unsigned most_gradings = 20;
// If the options ask for elements across gaps and give no gradation, sizes grow from the surfaces by this
// much per unit length, so that elements inside a gap are nearly as fine as those on its surfaces.
constexpr double gradation_in_gaps = 0.25;

}  // namespace

GradedSizes::GradedSizes(const Domain& domain, const RefinedMesh& mesh, const RestrictedSurface& surface)
    : domain_(domain),
      mesh_(mesh),
      surface_(surface),
      sizing_(domain.plc, domain.options, domain.frame),
      gradation_(domain.options.gradation == 0 && domain.options.elements_across_gap > 0
                     ? gradation_in_gaps
                     : domain.options.gradation) {
  if (gradation_ > 0) at_vertex_.resize(mesh_.vertex_count(), INFINITY);
}

void GradedSizes::impose(std::span<const Index> vertices, double size, double distance) {
  if (gradation_ == 0) return;
  for (const Index v : vertices) at_vertex_[v] = std::min(at_vertex_[v], size + gradation_ * distance);
}

void GradedSizes::cells_made(const ConflictZone& zone, Index vertex) {
  if (gradation_ == 0) return;
  assert(at_vertex_.size() == vertex);
  const Point& p = mesh_.point(vertex);
  double size = INFINITY;
  for (const Index cell : zone.created) size = std::min(size, sizing_.region_size(surface_.region(cell), p));
  const Feature& f = mesh_.feature(vertex);
  if (f.dimension == 1 || f.dimension == 2)
    size = std::min(size, sizing_.feature_size(f.dimension, f.index, p));
  for (const Index neighbour : zone.vertices)
    size = std::min(size, at_vertex_[neighbour] + gradation_ * distance(p, mesh_.point(neighbour)));
  at_vertex_.push_back(std::max(size, domain_.options.size_min));
}

bool GradedSizes::spread() {
  if (gradation_ == 0 || ++rounds_ > most_gradings) return false;
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) front.push({at_vertex_[v], v});
  std::vector<Index> adjacent;
  while (!front.empty()) {
    const auto [size, vertex] = front.top();
    front.pop();
    if (size > at_vertex_[vertex]) continue;
    mesh_.adjacent_vertices(vertex, adjacent);
    for (const Index other : adjacent) {
      const double graded = size + gradation_ * distance(mesh_.point(vertex), mesh_.point(other));
      if (graded >= at_vertex_[other] * (1 - 1e-6)) continue;
      at_vertex_[other] = graded;
      front.push({graded, other});
    }
  }
  return true;
}

}  // namespace collarmesh
