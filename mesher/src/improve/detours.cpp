#include "improve/detours.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/cell_shapes.h"
#include "common/contains.h"
#include "common/sort_uniquely.h"

namespace collarmesh::remeshing::improvement {

namespace {

// The lowest quality of tets that first steps may make.
constexpr double least_quality_on_way = 0.02;
constexpr unsigned most_detours = 30;
// Largest number of operations to try before the first detour is taken, and the increase of this number with
// each detour taken.
constexpr std::size_t first_trials = 2000, trials_per_detour = 200;
// Largest number of proposals for tets with angles near 180 degrees, each of which costs as much as several
// trials.
constexpr std::size_t most_obtuse = 2000;
constexpr double least_detour_gain = 1e-3, rounding = 1e-9;

// Compares two sorted lists of qualities from the worst up. Returns whether the first quality that differs is
// larger in `now`, by at least `least_detour_gain`. Where one list has ended, its qualities count as
// `wanted`.
bool is_better(const std::vector<double>& now, const std::vector<double>& before, double wanted) {
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    const double was = i < before.size() ? before[i] : wanted, is = i < now.size() ? now[i] : wanted;
    if (is > was * (1 + least_detour_gain)) return true;
    if (std::fabs(is - was) > rounding * std::fabs(was)) return false;
  }
  return false;
}

}  // namespace

bool Detours::exhausted() const {
  return obtuse_ >= most_obtuse ||
         trials_ >= std::min(most_trials_, first_trials + trials_per_detour * taken());
}

Change Detours::propose(Index tet) {
  if (chooser_.is_too_obtuse(tet)) ++obtuse_;
  return chooser_.propose(operations_, tet);
}

std::size_t Detours::take_all(std::vector<Index> tets, const std::function<bool()>& stopped) {
  assert(edited_.is_prepared() && chooser_.has_forgotten());
  bool any = true;
  while (any && !ended_) {
    any = false;
    for (const Effort effort : {Effort::at_tet, Effort::beside, Effort::last_resort})
      if (!any && !ended_) any = take_round(tets, effort, stopped);
  }
  return taken();
}

// Tries every tet once, worst first. Returns whether any detour was taken.
bool Detours::take_round(std::vector<Index>& tets, Effort effort, const std::function<bool()>& stopped) {
  const auto is_good = [this](Index t) { return chooser_.poor_quality(t) == INFINITY; };
  sort_worst_first(tets);
  Asked& asked = asked_[static_cast<unsigned>(effort)];
  const std::uint32_t before = taken();
  const std::size_t count = tets.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Index tet = tets[i];
    if (is_good(tet) || !is_new_to(tet, asked)) continue;
    asked.resize(std::max<std::size_t>(asked.size(), complex().size()), 0);
    asked[tet] = changes_.now() + 1;
    if (!chooser_.may_change_vertices(tet)) continue;
    ended_ = exhausted() || stopped();
    if (ended_) break;
    if (help(tet, effort)) note_changes(tets);
  }
  return taken() > before;
}

// Removes good tets and duplicates, and sorts the others by quality.
void Detours::sort_worst_first(std::vector<Index>& tets) const {
  std::vector<std::pair<double, Index>> poor;
  for (const Index t : tets)
    if (const double quality = chooser_.poor_quality(t); quality < INFINITY) poor.emplace_back(quality, t);
  sort_uniquely(poor);
  tets.clear();
  for (const auto& [quality, t] : poor) tets.push_back(t);
}

// Returns whether anything changed at a corner since the tet was tried.
bool Detours::is_new_to(Index tet, const Asked& asked) const {
  if (tet >= asked.size() || asked[tet] == 0) return true;
  return changes_.any_since(asked[tet], complex()[tet].corners);
}

void Detours::note_changes(std::vector<Index>& tets) {
  changes_.advance();
  changes_.resize(complex().mesh().points.size());
  for (const Index t : changed_) {
    if (!complex()[t].alive) continue;
    tets.push_back(t);
    for (const Index v : complex()[t].corners) changes_.note(v);
  }
}

// Improves a tet by a single operation if one helps now. Otherwise takes the first detour that leaves only
// good tets and does not make more tets thin. If there is none, takes the best detour that is worth it: one
// that does not make more tets thin, if possible, and leaves the best worst tet. Returns whether the mesh
// changed.
bool Detours::help(Index tet, Effort effort) {
  if (Change change = propose(tet); !change.is_none()) {
    ++trials_;
    Trial trial(edited_);
    trial.apply(std::move(change), [](Index) {});
    take(trial);
    return true;
  }
  const auto is_perfect = [this](const Result& r) { return r.worst >= chooser_.wanted() && !r.more_thin; };
  Result best;
  FirstStep step{};
  for (const Index place : places(tet, effort)) {
    const bool may_change_vertices = place == tet || chooser_.may_change_vertices(place);
    for (unsigned edge = 0; edge < cell_shapes::corner_pairs.size(); ++edge)
      for (const Operation operation :
           {Operation::collapse, Operation::collapse_turned, Operation::insertion, Operation::removal}) {
        if (operation != Operation::removal && !may_change_vertices) continue;
        const FirstStep tried{place, edge, operation};
        const Result found = attempt(tried, is_perfect);
        if (found.taken) return true;
        if (!found.better || !is_worth_it(found, effort)) continue;
        const auto worth = [](const Result& r) { return std::tuple(r.better, !r.more_thin, r.worst); };
        if (worth(found) > worth(best)) best = found, step = tried;
      }
  }
  return best.better && attempt(step, [](const Result&) { return true; }).taken;
}

// Returns whether to accept a result that makes the mesh better. Except as a last resort, it may make more
// tets thin only if it leaves no changed tet poor.
bool Detours::is_worth_it(const Result& result, Effort effort) const {
  return effort == Effort::last_resort || !result.more_thin || result.worst >= chooser_.wanted();
}

std::vector<Index> Detours::places(Index tet, Effort effort) const {
  if (effort == Effort::at_tet) return {tet};
  std::vector<Index> found, star;
  if (effort == Effort::last_resort) found.push_back(tet);
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
  const auto& corners = complex()[step.tet].corners;
  const auto [i, j] = cell_shapes::corner_pairs[step.edge];
  const Index a = corners[i], b = corners[j];
  Change change;
  const double above = least_quality_on_way;
  switch (step.operation) {
    case Operation::collapse: operations_.collapse_edge(a, b, change, above); break;
    case Operation::collapse_turned: operations_.collapse_edge(b, a, change, above); break;
    case Operation::insertion: operations_.split_edge_anyhow(a, b, above, change); break;
    case Operation::removal: operations_.remove_edge(step.tet, i, j, change, above); break;
  }
  return change;
}

// Tries a first step, and takes the detour if the result is better and `is_taken` returns true.
Detours::Result Detours::attempt(const FirstStep& step, const std::function<bool(const Result&)>& is_taken) {
  Change change = first_step(step);
  if (change.is_none()) return {};
  ++trials_;
  before_.clear(), to_improve_.clear();
  thin_before_ = 0;
  Trial trial(edited_);
  apply(trial, std::move(change));
  improve_changed(trial);
  Result found = result(trial);
  found.taken = found.better && is_taken(found);
  if (found.taken)
    take(trial);
  else
    trial.undo();
  return found;
}

void Detours::take(Trial& trial) {
  trial.keep();
  changed_ = trial.changed();
}

void Detours::apply(Trial& trial, Change change) {
  const auto see_before = [this](Index tet) {
    before_.push_back(std::min(chooser_.wanted(), chooser_.quality(tet)));
    thin_before_ += chooser_.is_thin(tet) ? 1 : 0;
  };
  for (const Index t : trial.apply(std::move(change), see_before))
    if (!contains(to_improve_, t)) to_improve_.push_back(t);
}

void Detours::improve_changed(Trial& trial) {
  const auto key = [this](Index t) { return std::pair(chooser_.poor_quality(t), t); };
  for (unsigned step = 0; step < most_detours && !to_improve_.empty(); ++step) {
    const auto worst = std::ranges::min_element(to_improve_, {}, key);
    const Index tet = *worst;
    if (chooser_.poor_quality(tet) == INFINITY) return;
    *worst = to_improve_.back();
    to_improve_.pop_back();
    Change change = propose(tet);
    if (!change.is_none()) apply(trial, std::move(change));
  }
}

Detours::Result Detours::result(const Trial& trial) const {
  std::vector<double> now, before = before_;
  std::size_t thin = 0;
  for (const Index t : trial.changed()) {
    if (!complex()[t].alive) continue;
    now.push_back(std::min(chooser_.wanted(), chooser_.quality(t)));
    thin += chooser_.is_thin(t) ? 1 : 0;
  }
  std::ranges::sort(before);
  std::ranges::sort(now);
  return {is_better(now, before, chooser_.wanted()), false, thin > thin_before_,
          now.empty() ? chooser_.wanted() : now.front()};
}

}  // namespace collarmesh::remeshing::improvement
