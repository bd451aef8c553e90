#include "adapt/relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/cell_shapes.h"
#include "common/sort_uniquely.h"

namespace collarmesh::remeshing::adapting {

namespace {

// Collapses must leave at least this share of the quality of the worst tet around.
constexpr double share_left = 0.3;
// Edges are collapsed below these shares of the target, one share after the other.
constexpr std::array lengths{0.05, 0.2, 0.5, 0.7};
// Qualities: tets are improved up to `good` between collapses and up to `better` afterwards, and no collapse
// makes a tet below `least`. A tet within the bounds on thin tets has at least 1.
constexpr double good = 1, better = 1.3, least = 1e-12;
constexpr unsigned most_relaxations = 4, most_improvements = 3;
// If a pass changes fewer than this share of the vertices or tets, it is the last one of its kind.
constexpr double least_share_changed = 0.005;
// Vertices with more tets are not collapsed, because all these tets would have to be replaced.
constexpr std::size_t most_tets = 400;
constexpr unsigned most_tries = 12;
constexpr std::size_t steps_between_reports = 1024;

}  // namespace

Relaxation::Relaxation(EditableMesh& edited, const MeshOptions& options, std::vector<double> sizes,
                       const Execution& execution)
    : edited_(edited),
      metric_(std::move(sizes)),
      bounds_{ThinShape(edited.plc, mesh(), options.bounds.thin_angle, options.bounds.reserve, edited.forced),
              CellBounds(edited.plc, mesh(), options.bounds)},
      rule_(bounds_, options.bounds.radius_edge, metric_),
      execution_(execution) {
  rule_.set_mode(coarsening::CoarseningRule::Mode::force);
  edited_.prepare();
}

void Relaxation::collapse() {
  for (const double length : lengths) {
    collapse_short(length);
    improve_tets(good, Means::vertices);
    collapse_again(length);
  }
}

void Relaxation::collapse_short(double below) {
  kept_.assign(mesh().points.size(), 0);
  collapse_again(below);
}

void Relaxation::improve() {
  improve_tets(better, Means::moves);
  collapse_again(lengths.back());
  improve_tets(better, Means::vertices);
}

/// Repeats collapses until a pass changes little.
void Relaxation::collapse_again(double below) {
  for (unsigned pass = 0; pass < most_relaxations; ++pass)
    if (!collapse_shorter_than(below)) break;
}

/// Improves tets until a pass changes little, at first by removing edges alone.
void Relaxation::improve_tets(double enough, Means later) {
  for (unsigned pass = 0; pass < most_improvements; ++pass)
    if (!improve_below(enough, pass == 0 ? Means::edges : later)) break;
}

bool Relaxation::collapse_shorter_than(double below) {
  std::vector<double> shortest(mesh().points.size(), INFINITY);
  for (Index t = 0; t < complex().size(); ++t) {
    if (!complex()[t].alive) continue;
    const auto& v = complex()[t].corners;
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      const double here = length(v[i], v[j]);
      for (const Index end : {v[i], v[j]}) shortest[end] = std::min(shortest[end], here);
    }
  }
  std::vector<Near> candidates;
  for (Index v = 0; v < shortest.size(); ++v)
    if (shortest[v] < below && mesh().features[v].dimension > 0) candidates.push_back({shortest[v], v});
  std::ranges::stable_sort(candidates, {}, &Near::length);
  const std::size_t before = collapses_;
  const bool ended = change_each(
      candidates,
      [&](Operations& operations, const Near& candidate, Proposal& found) {
        propose_collapse(operations, candidate.vertex, below, found);
      },
      [&](const Near& candidate, Proposal& found) {
        if (apply(found))
          ++collapses_;
        else
          kept_[candidate.vertex] = renewals_.advance();
      });
  return ended && static_cast<double>(collapses_ - before) >
                      least_share_changed * static_cast<double>(shortest.size());
}

/// Handles items in their order, with all threads. Returns false if it was stopped.
template <class Item, class Propose, class Use>
bool Relaxation::change_each(const std::vector<Item>& items, const Propose& propose, const Use& use) {
  return speculation_.for_each<Proposal>(
      items, changes_, propose,
      [&](const Item&, const Proposal& found, std::uint32_t begun) {
        return !found.read.empty() && !changes_.any_since(begun, found.read) &&
               edited_.curve_can_spare(found.change);
      },
      [&](const Item& item, Proposal& found) {
        if (stopped()) return false;
        use(item, found);
        return true;
      });
}

void Relaxation::propose_collapse(Operations& operations, Index vertex, double below, Proposal& found) const {
  found.change = {};
  found.read = {vertex};
  if (!complex().in_use(vertex) || kept_[vertex] > renewals_.at(vertex)) return;
  std::vector<Index> star;
  complex().star(vertex, star);
  if (star.size() > most_tets || !operations.begin_collapses(vertex, star)) return;
  const Neighbours neighbours = neighbours_of(vertex, star, below);
  const double least_quality = std::max(least, std::min(share_left * operations.worst_at_vertex(), good));
  const double longest = std::max(neighbours.longest, coarsening::CoarseningRule::longest_new);
  for (const Near& onto : neighbours.near) {
    found.read.push_back(onto.vertex);
    const bool fits = std::ranges::all_of(
        neighbours.all, [&](Index v) { return v == onto.vertex || length(onto.vertex, v) <= longest; });
    if (!fits) continue;
    operations.collapse_onto(onto.vertex, least_quality, 0, found.change);
    if (!found.change.is_none() && edited_.stays_oriented(found.change)) return;
    found.change = {};
  }
}

/// Returns the vertices joined to a vertex by an edge, and the `most_tries` nearest ones that it may be
/// collapsed onto, if shorter edges than `below` lead there.
Relaxation::Neighbours Relaxation::neighbours_of(Index vertex, const std::vector<Index>& star,
                                                 double below) const {
  Neighbours found;
  for (const Index t : star)
    for (const Index v : complex()[t].corners)
      if (v != vertex) found.all.push_back(v);
  sort_uniquely(found.all);
  for (const Index v : found.all) {
    const double here = length(vertex, v);
    found.longest = std::max(found.longest, here);
    if (here < below && edited_.may_share_feature(vertex, v)) found.near.push_back({here, v});
  }
  std::ranges::stable_sort(found.near, {}, &Near::length);
  if (found.near.size() > most_tries) found.near.resize(most_tries);
  return found;
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
  const bool ended = change_each(
      poor,
      [&](Operations& operations, const Poor& item, Proposal& found) {
        found.change = {};
        found.read.clear();
        if (complex()[item.tet].alive && quality(item.tet) == item.quality)
          propose_improvement(operations, item.tet, enough, means, found);
      },
      [&](const Poor& item, Proposal& found) {
        if (apply(found)) {
          ++others_;
        } else if (!found.read.empty()) {
          auto& tried = not_better_[static_cast<unsigned>(means)];
          tried.resize(std::max<std::size_t>(tried.size(), complex().size()), 0);
          tried[item.tet] = renewals_.advance();
        }
      });
  return ended &&
         static_cast<double>(others_ - before) > least_share_changed * static_cast<double>(complex().size());
}

void Relaxation::propose_improvement(Operations& operations, Index tet, double enough, Means means,
                                     Proposal& found) const {
  const auto corners = complex()[tet].corners;
  found.read.assign(corners.begin(), corners.end());
  Change& change = found.change;
  for (const auto& [i, j] : longest_first(complex().corners(tet), distance)) {
    operations.remove_edge(tet, i, j, change);
    if (!change.is_none() && change.quality >= enough) break;
  }
  for (const Index v : corners)
    if (means != Means::edges && change.is_none()) operations.move_vertex(v, change);
  for (const Index v : corners)
    if (means != Means::edges && change.is_none()) operations.move_to_face(v, change);
  // Copy `change.read` now: the collapses below overwrite it.
  for (const Index t : change.read)
    found.read.insert(found.read.end(), complex()[t].corners.begin(), complex()[t].corners.end());
  for (const Index v : corners)
    for (const Index w : corners)
      if (means == Means::vertices && v != w && change.is_none()) operations.collapse_edge(v, w, change);
  if (!change.is_none() && !edited_.stays_oriented(change)) change = {};
}

/// Makes the proposed change. Returns false if there is none.
bool Relaxation::apply(Proposal& found) {
  if (found.change.is_none()) return false;
  changes_.advance(), renewals_.advance();
  for (const Index t : found.change.replacement.old)
    for (const Index v : complex()[t].corners) changes_.note(v);
  for (const Index t : edited_.apply(std::move(found.change)))
    for (const Index v : complex()[t].corners) changes_.note(v), renewals_.note(v);
  return true;
}

/// Returns whether improving a tet with these or more means has failed since its corners last changed.
bool Relaxation::was_tried(Index tet, Means means) const {
  for (auto kind = static_cast<unsigned>(means); kind < kinds_of_means; ++kind) {
    const auto& tried = not_better_[kind];
    if (tet < tried.size() && tried[tet] > 0 && !renewals_.any_since(tried[tet], complex()[tet].corners))
      return true;
  }
  return false;
}

bool Relaxation::stopped() {
  return execution_.cancelled() ||
         (++steps_ % steps_between_reports == 0 && execution_.progress &&
          !execution_.progress({"remesh", 0, mesh().points.size(), complex().size()}));
}

}  // namespace collarmesh::remeshing::adapting
