#include "adapt/relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/cell_shapes.h"
#include "common/sort_uniquely.h"

namespace collarmesh::remeshing::adapting {

namespace {

// Collapses and divisions must leave at least this share of the quality of the worst tet around.
constexpr double share_left = 0.3;
// Edges are collapsed below these shares of the target, one share after the other.
constexpr std::array lengths{0.05, 0.2, 0.5, 0.7};
// Qualities. A tet within the bounds on thin tets has at least 1.
constexpr double good = 1, better = 1.3, least = 1e-12;
constexpr unsigned most_relaxations = 4, most_improvements = 3;
// If a pass changes fewer than this share of the vertices or tets, it is the last one of its kind.
constexpr double least_share_changed = 0.005;
// Vertices with more tets are not collapsed, because all these tets would have to be replaced.
constexpr std::size_t most_tets = 400;
constexpr unsigned most_tries = 12;
constexpr std::size_t steps_between_reports = 1024;

}  // namespace

Relaxation::Relaxation(EditableMesh& edited, const MeshOptions& options, const std::vector<double>& sizes,
                       const Execution& execution)
    : edited_(edited),
      sizes_(sizes),
      bounds_{ThinShape(edited.plc, mesh(), options.bounds.thin_angle, options.bounds.reserve, edited.forced),
              CellBounds(edited.plc, mesh(), options.bounds)},
      rule_(bounds_, options.bounds.radius_edge, sizes_),
      operations_(edited, rule_),
      execution_(execution),
      changed_(mesh().points.size(), 0),
      kept_(mesh().points.size(), 0) {
  rule_.set_mode(coarsening::CoarseningRule::Mode::force);
  edited_.prepare();
}

void Relaxation::contract() {
  for (const double length : lengths) {
    contract_short(length);
    improve_tets(good, Means::vertices);
    contract_again(length);
  }
}

void Relaxation::contract_short(double below) {
  kept_.assign(mesh().points.size(), 0);
  contract_again(below);
}

void Relaxation::improve() {
  improve_tets(better, Means::moves);
  contract_again(lengths.back());
  improve_tets(better, Means::vertices);
}

/// Repeats collapses as long as that is worthwhile.
void Relaxation::contract_again(double below) {
  for (unsigned pass = 0; pass < most_relaxations; ++pass)
    if (!contract_shorter_than(below)) break;
}

/// Improves tets as long as that is worthwhile, at first by removing edges alone.
void Relaxation::improve_tets(double enough, Means later) {
  for (unsigned pass = 0; pass < most_improvements; ++pass)
    if (!improve_below(enough, pass == 0 ? Means::edges : later)) break;
}

double Relaxation::relative_length(Index a, Index b) const {
  return distance(mesh().points[a], mesh().points[b]) / (0.5 * (sizes_[a] + sizes_[b]));
}

bool Relaxation::contract_shorter_than(double below) {
  std::vector<double> shortest(mesh().points.size(), INFINITY);
  for (Index t = 0; t < complex().size(); ++t) {
    if (!complex()[t].alive) continue;
    const auto& v = complex()[t].corners;
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      const double length = relative_length(v[i], v[j]);
      for (const Index end : {v[i], v[j]}) shortest[end] = std::min(shortest[end], length);
    }
  }
  std::vector<Near> candidates;
  for (Index v = 0; v < shortest.size(); ++v)
    if (shortest[v] < below && mesh().features[v].dimension > 0) candidates.push_back({shortest[v], v});
  std::ranges::stable_sort(candidates, {}, &Near::relative_length);
  const std::size_t before = contractions_;
  for (const Near& candidate : candidates) {
    if (stopped()) return false;
    const Index v = candidate.vertex;
    if (!complex().in_use(v) || kept_[v] > changed_[v]) continue;
    if (contract_at(v, below))
      ++contractions_;
    else
      kept_[v] = ++now_;
  }
  return static_cast<double>(contractions_ - before) >
         least_share_changed * static_cast<double>(shortest.size());
}

bool Relaxation::contract_at(Index vertex, double below) {
  complex().star(vertex, star_);
  if (star_.size() > most_tets || !operations_.begin_contractions(vertex, star_)) return false;
  find_neighbours(vertex, below);
  const double least_quality = std::max(least, std::min(share_left * operations_.worst_at_vertex(), good));
  unsigned tries = 0;
  for (const Near& onto : near_) {
    if (++tries > most_tries) return false;
    const bool fits = std::ranges::all_of(neighbours_, [&](Index v) {
      return v == onto.vertex ||
             relative_length(onto.vertex, v) <= std::max(longest_, coarsening::CoarseningRule::longest_new);
    });
    if (!fits) continue;
    Change change;
    operations_.contract_onto(onto.vertex, least_quality, 0, change);
    if (change.is_none() || !edited_.stays_oriented(change) || !edited_.curve_can_spare(change)) continue;
    apply(std::move(change));
    return true;
  }
  return false;
}

/// Finds the vertices joined to a vertex by an edge, the longest such edge, and the vertices that are near
/// enough to collapse onto.
void Relaxation::find_neighbours(Index vertex, double below) {
  neighbours_.clear();
  for (const Index t : star_)
    for (const Index v : complex()[t].corners)
      if (v != vertex) neighbours_.push_back(v);
  sort_uniquely(neighbours_);
  near_.clear();
  longest_ = 0;
  for (const Index v : neighbours_) {
    const double length = relative_length(vertex, v);
    longest_ = std::max(longest_, length);
    if (length < below && may_share_feature(vertex, v)) near_.push_back({length, v});
  }
  std::ranges::stable_sort(near_, {}, &Near::relative_length);
}

bool Relaxation::may_share_feature(Index vertex, Index onto) const {
  const auto &f = mesh().features[vertex], &g = mesh().features[onto];
  return f.dimension == 3 || g.dimension < f.dimension ||
         (g.dimension == f.dimension && g.feature == f.feature);
}

bool Relaxation::improve_below(double enough, Means means) {
  struct Poor {
    double quality;
    Index tet;
  };
  std::vector<Poor> poor;
  for (Index t = 0; t < complex().size(); ++t)
    if (complex()[t].alive && !was_tried(t, means))
      if (const double q = quality(t); q < enough) poor.push_back({q, t});
  std::ranges::stable_sort(poor, {}, &Poor::quality);
  const std::size_t before = others_;
  for (const Poor& item : poor) {
    if (stopped()) return false;
    if (!complex()[item.tet].alive || quality(item.tet) != item.quality) continue;
    Change change = improvement_of(item.tet, enough, means);
    if (change.is_none() || !edited_.stays_oriented(change)) {
      auto& tried = not_better_[static_cast<unsigned>(means)];
      if (tried.size() < complex().size()) tried.resize(complex().size(), 0);
      tried[item.tet] = ++now_;
      continue;
    }
    if (change.kind == Change::Kind::contraction && !edited_.curve_can_spare(change)) continue;
    apply(std::move(change));
    ++others_;
  }
  return static_cast<double>(others_ - before) > least_share_changed * static_cast<double>(complex().size());
}

Change Relaxation::improvement_of(Index tet, double enough, Means means) {
  const auto corners = complex()[tet].corners;
  Change change;
  const auto found = [&] { return !change.is_none(); };
  for (const auto& [i, j] : longest_first(complex().corners(tet), distance)) {
    operations_.remove_edge(tet, i, j, change);
    if (found() && change.quality >= enough) return change;
  }
  if (means == Means::edges) return change;
  for (const Index v : corners)
    if (!found()) operations_.move_vertex(v, change);
  for (const Index v : corners)
    if (!found()) operations_.move_to_face(v, change);
  if (means == Means::moves) return change;
  for (const Index v : corners)
    for (const Index w : corners)
      if (v != w && !found()) operations_.contract_edge(v, w, change);
  return change;
}

void Relaxation::apply(Change change) {
  ++now_;
  for (const Index t : edited_.apply(std::move(change)))
    for (const Index v : complex()[t].corners) changed_[v] = now_;
}

bool Relaxation::has_changed_since(Index tet, std::uint32_t when) const {
  const auto& v = complex()[tet].corners;
  return std::ranges::any_of(v, [&](Index w) { return changed_[w] >= when; });
}

/// Returns whether improving a tet with these or more means has failed since its corners last changed.
bool Relaxation::was_tried(Index tet, Means means) const {
  for (auto kind = static_cast<unsigned>(means); kind < kinds_of_means; ++kind) {
    const auto& tried = not_better_[kind];
    if (tet < tried.size() && tried[tet] > 0 && !has_changed_since(tet, tried[tet])) return true;
  }
  return false;
}

bool Relaxation::stopped() {
  return execution_.cancelled() ||
         (++steps_ % steps_between_reports == 0 && execution_.progress &&
          !execution_.progress({"remesh", 0, mesh().points.size(), complex().size()}));
}

}  // namespace collarmesh::remeshing::adapting
