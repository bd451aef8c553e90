#include "improve/detours.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace collarmesh::improvement {

namespace {

// First steps at a tet: contractions of its edges both ways, vertices inserted in them, edges removed.
constexpr unsigned contractions = 12, insertions = 6, removals = 6;
constexpr std::array<std::array<unsigned, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
// They may make tets as poor as this.
constexpr double least_quality = 0.02;
constexpr unsigned most_steps = 30;
// Rather than leave a tet poor a detour may make so many tets thin.
constexpr std::size_t most_more_thin = 2;
constexpr double least_gain = 1e-3, rounding = 1e-9;

bool contains(const auto& range, Index x) { return std::find(range.begin(), range.end(), x) != range.end(); }

// From the worst up: is the first that differs larger now? Both sorted; one that is missing is good.
bool better(const std::vector<double>& before, const std::vector<double>& now, double wanted) {
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    const double was = i < before.size() ? before[i] : wanted, is = i < now.size() ? now[i] : wanted;
    if (is > was * (1 + least_gain)) return true;
    if (is < was * (1 - rounding)) return false;
  }
  return false;
}

}  // namespace

Detours::Detours(Workpiece& workpiece, const SliverRule& rule, Remedies& remedies, Operations& operations,
                 std::size_t most_trials)
    : workpiece_(workpiece),
      rule_(rule),
      remedies_(remedies),
      operations_(operations),
      most_trials_(most_trials) {}

std::size_t Detours::take(std::vector<Index> tets, const std::function<bool()>& stopped) {
  const auto key = [this](Index t) { return std::pair(remedies_.poor_quality(t), t); };
  std::uint32_t before = 0;
  do {
    before = taken_;
    std::erase_if(tets, [this](Index t) { return remedies_.poor_quality(t) == INFINITY; });
    std::ranges::sort(tets, {}, key);
    const auto repeated = std::ranges::unique(tets);
    tets.erase(repeated.begin(), repeated.end());
    const std::size_t count = tets.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Index tet = tets[i];
      if (remedies_.poor_quality(tet) == INFINITY || !is_new_to(tet)) continue;
      asked_at_.resize(std::max<std::size_t>(asked_at_.size(), complex().size()), 0);
      asked_at_[tet] = taken_ + 1;
      if (!remedies_.may_change_vertices(tet)) continue;
      if (exhausted() || stopped()) return taken_;
      if (!take(tet)) continue;
      ++taken_;
      note_changes();
      tets.insert(tets.end(), changed_.begin(), changed_.end());
    }
  } while (taken_ > before);
  return taken_;
}

// Has anything changed at a corner since the tet was asked?
bool Detours::is_new_to(Index tet) const {
  if (tet >= asked_at_.size() || asked_at_[tet] == 0) return true;
  return std::ranges::any_of(complex()[tet].corners, [&](Index v) {
    return v < changed_at_.size() && changed_at_[v] >= asked_at_[tet];
  });
}

void Detours::note_changes() {
  changed_at_.resize(complex().mesh().points.size(), 0);
  for (const Index t : changed_)
    for (const Index v : complex()[t].corners) changed_at_[v] = taken_;
}

bool Detours::take(Index tet) {
  const double before = remedies_.quality(tet);
  double best = 0;
  FirstStep step{none, 0};
  for (const Index place : places(tet)) {
    for (unsigned operation = 0; operation < contractions + insertions + removals; ++operation) {
      const auto [worst, more_thin] = attempt({place, operation});
      if (worst >= remedies_.wanted() && more_thin == 0) {
        workpiece_.keep();
        return true;
      }
      if (worst < 0) continue;
      workpiece_.undo();
      // No more thin tets first.
      const double worth = more_thin == 0                                                     ? 1 + worst
                           : more_thin <= most_more_thin && worst > before * (1 + least_gain) ? worst
                                                                                              : 0;
      if (worth > best) best = worth, step = {place, operation};
    }
    if (best >= remedies_.wanted() || exhausted()) break;
  }
  if (best == 0) return false;
  attempt(step);
  workpiece_.keep();
  return true;
}

// The tet, the neighbours across its faces, then those across its edges.
std::vector<Index> Detours::places(Index tet) const {
  std::vector<Index> found{tet}, star;
  const auto& corners = complex()[tet].corners;
  const auto add = [&](Index t) {
    if (!complex()[t].collar && !contains(found, t)) found.push_back(t);
  };
  for (const Index t : complex()[tet].neighbours)
    if (t != none) add(t);
  for (const Index v : corners) {
    complex().star(v, star);
    for (const Index t : star)
      if (std::ranges::count_if(complex()[t].corners, [&](Index w) { return contains(corners, w); }) == 2)
        add(t);
  }
  return found;
}

Change Detours::first_step(const FirstStep& step) {
  const auto corners = complex()[step.tet].corners;
  Change change;
  if (step.operation < contractions) {
    const auto [i, j] = edges[step.operation / 2];
    const bool turned = step.operation % 2 != 0;
    const Index vertex = corners[turned ? j : i], onto = corners[turned ? i : j];
    if (operations_.begin_contractions(vertex)) operations_.contract_onto(onto, least_quality, 0, change);
  } else if (step.operation < contractions + insertions) {
    const auto [i, j] = edges[step.operation - contractions];
    operations_.split_edge_anyhow(corners[i], corners[j], least_quality, change);
  } else {
    const auto [i, j] = edges[step.operation - contractions - insertions];
    operations_.remove_edge_anyhow(step.tet, i, j, least_quality, change);
  }
  if (change.kind == Change::Kind::contraction && !workpiece_.curve_can_spare(change)) change = {};
  return change;
}

// When it is better, the trial is open afterwards.
Detours::Outcome Detours::attempt(const FirstStep& step) {
  ++trials_;
  Change change = first_step(step);
  if (change.kind == Change::Kind::none) return {};
  ++trial_;
  changed_.clear(), before_.clear(), to_improve_.clear();
  thin_before_ = 0;
  workpiece_.begin_trial();
  apply(std::move(change));
  improve_changed();
  const Outcome found = outcome();
  if (found.worst < 0) workpiece_.undo();
  return found;
}

void Detours::apply(Change change) {
  std::vector<Index> star;
  if (change.kind == Change::Kind::move) complex().star(change.vertex, star);
  for (const Index t : star) see_before(t);
  for (const Index t : change.replacement.old) see_before(t);
  for (const Index t : workpiece_.apply(std::move(change))) {
    set_changed(t);
    remedies_.changed(t);
    if (!contains(to_improve_, t)) to_improve_.push_back(t);
  }
}

void Detours::improve_changed() {
  for (unsigned step = 0; step < most_steps && !to_improve_.empty(); ++step) {
    const auto worst = std::ranges::min_element(
        to_improve_, {}, [this](Index t) { return std::pair(remedies_.poor_quality(t), t); });
    const Index tet = *worst;
    if (remedies_.poor_quality(tet) == INFINITY) return;
    *worst = to_improve_.back();
    to_improve_.pop_back();
    Change change = remedies_.propose(operations_, tet);
    if (change.kind == Change::Kind::contraction && !workpiece_.curve_can_spare(change)) continue;
    if (change.kind != Change::Kind::none) apply(std::move(change));
  }
}

Detours::Outcome Detours::outcome() const {
  std::vector<double> now, before = before_;
  std::size_t thin = 0;
  for (const Index t : changed_) {
    if (!complex()[t].alive) continue;
    now.push_back(std::min(remedies_.wanted(), remedies_.quality(t)));
    thin += is_thin(t) ? 1 : 0;
  }
  std::ranges::sort(before);
  std::ranges::sort(now);
  if (!better(before, now, remedies_.wanted())) return {};
  return {now.empty() ? remedies_.wanted() : now.front(), thin > thin_before_ ? thin - thin_before_ : 0};
}

// A tet is about to change that may have been there before.
void Detours::see_before(Index tet) {
  if (tet < changed_in_.size() && changed_in_[tet] == trial_) return;
  set_changed(tet);
  before_.push_back(std::min(remedies_.wanted(), remedies_.quality(tet)));
  thin_before_ += is_thin(tet) ? 1 : 0;
}

void Detours::set_changed(Index tet) {
  if (tet >= changed_in_.size()) changed_in_.resize(complex().size(), 0);
  if (changed_in_[tet] == trial_) return;
  changed_in_[tet] = trial_;
  changed_.push_back(tet);
}

}  // namespace collarmesh::improvement
