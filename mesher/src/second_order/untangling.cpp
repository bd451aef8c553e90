#include "second_order/untangling.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>

#include "collarmesh/curved_tet.h"
#include "common/sort_uniquely.h"
#include "second_order/jacobian_coefficients.h"

namespace collarmesh::second_order {

namespace {

// Distance of the barrier below the least coefficient, relative to the straight tet's coefficient:
// `barrier_gap` or, if that is more, `barrier_share` of the least coefficient's distance from 1.
constexpr double barrier_gap = 0.02, barrier_share = 0.1;
constexpr unsigned most_barriers = 12, steps_per_barrier = 15, remembered_steps = 6, most_halvings = 12;
// If the least coefficient rises by less than this with one barrier, the nodes cannot move far enough.
constexpr double least_rise = 0.01;
// Moving nodes in a wider neighbourhood is slow, so it is given up after this many failures.
constexpr std::size_t most_wide_failures = 100;
// The first step moves no node farther than this share of the shortest edge.
constexpr double first_step = 0.05;

double dot(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += collarmesh::dot(a[i], b[i]);
  return sum;
}

void add(std::vector<Vector>& to, double factor, const std::vector<Vector>& what) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = to[i] + factor * what[i];
}

/// The direction of a quasi-Newton method from the last steps (L-BFGS; Nocedal and Wright, Numerical
/// Optimization, algorithm 7.4).
class Directions {
 public:
  void note(std::vector<Vector> step, std::vector<Vector> gradient_change) {
    const double product = dot(step, gradient_change);
    if (!(product > 0)) return;
    pairs_.push_back({std::move(step), std::move(gradient_change), 1 / product});
    if (pairs_.size() > remembered_steps) pairs_.pop_front();
  }
  bool empty() const { return pairs_.empty(); }
  std::vector<Vector> downhill(std::vector<Vector> gradient) const {
    std::vector<double> alpha(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      alpha[i] = pairs_[i].inverse * dot(pairs_[i].step, gradient);
      add(gradient, -alpha[i], pairs_[i].change);
    }
    if (!pairs_.empty()) {
      const Pair& last = pairs_.back();
      const double scale = 1 / (last.inverse * dot(last.change, last.change));
      for (Vector& g : gradient) g = scale * g;
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      add(gradient, alpha[i] - pairs_[i].inverse * dot(pairs_[i].change, gradient), pairs_[i].step);
    for (Vector& g : gradient) g = -1.0 * g;
    return gradient;
  }

 private:
  struct Pair {
    std::vector<Vector> step, change;
    double inverse;  // inverse of the product of step and change of gradient
  };
  std::deque<Pair> pairs_;
};

}  // namespace

Untangling::Untangling(TetMesh& mesh, const MeshEdges& edges, const Plc& plc, double least_jacobian)
    : mesh_(mesh), edges_(edges), plc_(plc), least_jacobian_(least_jacobian) {}

bool Untangling::is_free(Index edge) const {
  const TetMesh::VertexFeature& feature = edges_.feature(edge);
  return feature.dimension == 3 ||
         (feature.dimension == 2 && feature.feature != none && plc_.patches[feature.feature].planar);
}

std::size_t Untangling::untangle_farther(Index tet) {
  if (wide_failures_ >= most_wide_failures) return 0;
  const std::size_t moved = untangle_within(tet, true);
  if (moved == 0) ++wide_failures_;
  return moved;
}

std::size_t Untangling::untangle_within(Index tet, bool wide) {
  assert(mesh_.order() == 2);
  const auto& nodes = mesh_.tet_mid_nodes[tet];
  const auto is_free = [this](Index node) { return may_move(node - edges_.first_node()); };
  if (std::ranges::none_of(nodes, is_free)) return 0;
  gather(tet, wide);
  std::vector<Point> before;
  for (const Free& f : free_) before.push_back(mesh_.points[f.node]);
  std::vector<Index> valid;
  for (const Index t : tets_)
    if (is_valid(t)) valid.push_back(t);
  const auto done = [&] {
    return is_valid(tet) && std::ranges::all_of(valid, [this](Index t) { return is_valid(t); });
  };
  double least = least_coefficient();
  for (unsigned i = 0; i < most_barriers; ++i) {
    minimize(least - std::max(barrier_gap, barrier_share * (1 - least)));
    const double risen = least_coefficient() - least;
    least += risen;
    if (!(least > 0 && done())) {
      if (risen < least_rise) break;
      continue;
    }
    std::size_t moved = 0;
    for (std::size_t f = 0; f < free_.size(); ++f) moved += mesh_.points[free_[f].node] != before[f] ? 1 : 0;
    return moved;
  }
  for (std::size_t f = 0; f < free_.size(); ++f) mesh_.points[free_[f].node] = before[f];
  return 0;
}

// Collects the free nodes of the tet and of all tets that share an edge with it (if `wide`, a corner), and
// the tets at these nodes.
void Untangling::gather(Index tet, bool wide) {
  std::vector<Index> near;
  if (wide)
    for (const Index v : mesh_.tets[tet]) {
      const auto at = tets_at_vertex_[v];
      near.insert(near.end(), at.begin(), at.end());
    }
  const auto add_tets_at = [this](Index node, std::vector<Index>& tets) {
    const std::vector<Index> at = tets_at(node - edges_.first_node());
    tets.insert(tets.end(), at.begin(), at.end());
  };
  for (const Index node : mesh_.tet_mid_nodes[tet]) add_tets_at(node, near);
  free_.clear(), free_at_.clear(), tets_.clear(), free_of_tets_.clear(), six_volumes_.clear();
  for (const Index t : near)
    for (const Index node : mesh_.tet_mid_nodes[t]) {
      const Index edge = node - edges_.first_node();
      if (!may_move(edge) || !free_at_.emplace(node, static_cast<Index>(free_.size())).second) continue;
      const TetMesh::VertexFeature& feature = edges_.feature(edge);
      free_.push_back({node, feature.dimension == 3 ? Vector{} : plc_.patches[feature.feature].normal});
    }
  for (const Free& f : free_) add_tets_at(f.node, tets_);
  sort_uniquely(tets_);
  for (const Index t : tets_) {
    const auto& [a, b, c, d] = mesh_.tets[t];
    six_volumes_.push_back(six_volume(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]));
    std::array<Index, 6>& of_tet = free_of_tets_.emplace_back();
    for (std::size_t k = 0; k < 6; ++k) {
      const auto at = free_at_.find(mesh_.tet_mid_nodes[t][k]);
      of_tet[k] = at != free_at_.end() ? at->second : none;
    }
  }
}

std::vector<Index> Untangling::tets_at(Index edge) {
  if (tets_at_vertex_.empty()) tets_at_vertex_ = {mesh_.tets, edges_.first_node()};
  const auto [a, end] = edges_.ends(edge);
  std::vector<Index> found;
  for (const Index t : tets_at_vertex_[a])
    if (std::ranges::find(mesh_.tets[t], end) != mesh_.tets[t].end()) found.push_back(t);
  return found;
}

bool Untangling::is_valid(Index tet) const {
  return jacobian_exceeds(curved_tet(mesh_, tet), least_jacobian_);
}

double Untangling::least_coefficient() const {
  double least = INFINITY;
  for (std::size_t i = 0; i < tets_.size(); ++i)
    least = std::min(least, JacobianCoefficients(curved_tet(mesh_, tets_[i])).least() / six_volumes_[i]);
  return least;
}

// Returns the objective; infinite if a coefficient does not exceed the barrier.
double Untangling::objective(double barrier, std::vector<Vector>* gradient) const {
  if (gradient != nullptr) gradient->assign(free_.size(), {});
  double sum = 0;
  for (std::size_t i = 0; i < tets_.size(); ++i) {
    const JacobianCoefficients coefficients(curved_tet(mesh_, tets_[i]));
    JacobianCoefficients::Values weights;
    for (std::size_t c = 0; c < JacobianCoefficients::count; ++c) {
      const double b = coefficients.values()[c] / six_volumes_[i];
      if (!(b > barrier)) return INFINITY;
      const double logarithm = std::log((b - barrier) / (1 - barrier));
      sum += logarithm * logarithm + (b - 1) * (b - 1);
      weights[c] = 2 * (logarithm / (b - barrier) + b - 1) / six_volumes_[i];
    }
    if (gradient == nullptr) continue;
    const std::array<Vector, 6> by_nodes = coefficients.gradient(weights);
    for (std::size_t k = 0; k < 6; ++k)
      if (const Index f = free_of_tets_[i][k]; f != none) (*gradient)[f] = (*gradient)[f] + by_nodes[k];
  }
  if (gradient != nullptr)
    for (std::size_t f = 0; f < free_.size(); ++f)
      (*gradient)[f] = (*gradient)[f] - collarmesh::dot((*gradient)[f], free_[f].normal) * free_[f].normal;
  return sum;
}

void Untangling::minimize(double barrier) {
  std::vector<Vector> gradient, next_gradient;
  double value = objective(barrier, &gradient);
  Directions directions;
  double shortest = INFINITY;
  for (const Free& f : free_) {
    const auto [a, b] = edges_.ends(f.node - edges_.first_node());
    shortest = std::min(shortest, distance(mesh_.points[a], mesh_.points[b]));
  }
  for (unsigned step = 0; step < steps_per_barrier; ++step) {
    std::vector<Vector> way = directions.downhill(gradient);
    double slope = dot(way, gradient), farthest = 0;
    if (!(slope < 0)) break;
    for (const Vector& w : way) farthest = std::max(farthest, norm(w));
    double length = directions.empty() ? first_step * shortest / farthest : 1;
    const std::vector<Point> before = [&] {
      std::vector<Point> points;
      for (const Free& f : free_) points.push_back(mesh_.points[f.node]);
      return points;
    }();
    double after = INFINITY, gone = length;
    bool has_gradient = false;
    for (unsigned h = 0; h < most_halvings; ++h, length *= 0.5) {
      gone = length;
      for (std::size_t f = 0; f < free_.size(); ++f)
        mesh_.points[free_[f].node] = before[f] + length * way[f];
      has_gradient = h == 0;  // the first step length is usually right
      after = objective(barrier, has_gradient ? &next_gradient : nullptr);
      if (after <= value + 1e-4 * length * slope) break;
    }
    if (!(after < value)) {
      for (std::size_t f = 0; f < free_.size(); ++f) mesh_.points[free_[f].node] = before[f];
      break;
    }
    if (!has_gradient) objective(barrier, &next_gradient);
    for (Vector& w : way) w = gone * w;
    add(gradient, -1, next_gradient);
    for (Vector& g : gradient) g = -1.0 * g;
    directions.note(std::move(way), gradient);
    gradient = next_gradient;
    value = after;
  }
}

}  // namespace collarmesh::second_order
