// Gradation: target edge lengths grow by at most `gradation` per unit length from where they are
// small. A vertex takes the smallest size that its neighbours allow when it is
// inserted; sizes that became smaller later are spread when the queue has run empty.
#include <algorithm>
#include <queue>

#include "refine/refinement.h"

namespace collarmesh {

namespace {

constexpr unsigned most_rounds = 20;

}  // namespace

void Refinement::grade_vertex(Index vertex) {
  if (gradation_ == 0) return;
  const Point& p = mesh_.point(vertex);
  double size = INFINITY;
  for (const Index cell : zone_.created) size = std::min(size, sizing_.region_size(labels_[cell].region, p));
  const MeshVertex& v = vertices_[vertex];
  if (v.dimension == 1 || v.dimension == 2)
    size = std::min(size, sizing_.feature_size(v.dimension, v.feature, p));
  for (const Index neighbour : zone_.vertices)
    size = std::min(size, target_size_[neighbour] + gradation_ * distance(p, mesh_.point(neighbour)));
  target_size_.push_back(std::max(size, options_.size_min));
}

bool Refinement::check_gradation() {
  if (gradation_ == 0 || !message_.empty() || ++gradation_rounds_ > most_rounds) return false;
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) front.push({target_size_[v], v});
  std::vector<Index> adjacent;
  while (!front.empty()) {
    const auto [size, vertex] = front.top();
    front.pop();
    if (size > target_size_[vertex]) continue;
    mesh_.adjacent_vertices(vertex, adjacent);
    for (const Index other : adjacent) {
      const double graded = size + gradation_ * distance(mesh_.point(vertex), mesh_.point(other));
      if (graded >= target_size_[other] * (1 - 1e-6)) continue;
      target_size_[other] = graded;
      front.push({graded, other});
    }
  }
  const std::size_t before = queue_.pushed();
  for (Index s = 0; s < subsegments_.size(); ++s)
    if (subsegments_[s].alive && too_coarse(subsegments_[s])) encroach(s);
  for (const FaceId face : marked_faces())
    if (!restricted(face).given_up) judge_triangle(face);
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell)) judge_cell(cell);
  return queue_.pushed() > before;
}

}  // namespace collarmesh
