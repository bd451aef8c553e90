#include "collarmesh/coarsen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <climits>
#include <cmath>
#include <optional>

#include "coarsen/coarsen_edited.h"
#include "coarsen/failed_repairs.h"
#include "coarsen/proposals.h"
#include "coarsen/repair_chances.h"
#include "coarsen/target_sizes.h"
#include "collarmesh/error.h"
#include "common/cell_shapes.h"
#include "common/found_in_ranges.h"
#include "common/parallel_for.h"
#include "common/shared_bounds.h"
#include "common/sort_uniquely.h"
#include "common/stopwatch.h"
#include "common/tet_sides.h"
#include "common/thread_limit.h"
#include "remesh/ordered_speculation.h"

namespace collarmesh {

namespace remeshing::coarsening {
namespace {

using Mode = CoarseningRule::Mode;

constexpr unsigned plain_passes = 4, repair_passes = 6, rounds = 12;
// Largest number of repair steps per collapse. A step rarely fixes two tets, so repair gives up when more
// tets are poor than steps remain.
constexpr unsigned most_repairs = 24;
// Only vertices whose shortest edge is below this share of its target length get collapses with repairs,
// because most of these collapses fail.
constexpr double repaired_below = 0.65;
// Collapses of a vertex inside a region are tried if its shortest edge is below this share of the target
// length. After refinement many of these vertices have a slightly longer one, which can hardly ever be
// collapsed.
constexpr double asked_inside_below = 0.75;
constexpr unsigned most_sweeps = 8;
// A pass that removes less than this share of the tets ends its round. A round is the last one if it
// removes less than this share and the improvement at its beginning left nothing more to improve. But if at
// least one in `collapses_per_repair` collapses needed repairs, another round first tries all vertices again.
constexpr double least_share = 0.005;
constexpr std::size_t collapses_per_repair = 10;
constexpr std::size_t steps_between_reports = 4096;
// If the log has more than one change for each `tets_per_logged_change` tets, visiting all tets costs less
// than finding the tets at the changed vertices.
constexpr std::size_t tets_per_logged_change = 24;
// The items of each rank are cut into the same number of rows: the number of items of all ranks divided by
// `items_per_row`, and at most `most_rows`.
constexpr std::size_t most_rows = 256, items_per_row = 16;
constexpr double ranks_of_lengths = 64;  // ranks per unit of squared length in the metric

constexpr double square(double x) { return x * x; }

// Returns the rank of a quality, from the worst up: two ranks for each factor of two.
int rank_of_quality(double quality) { return quality > 0 ? std::ilogb(quality * quality) : INT_MIN; }

// Sorts items by rank. Items of one rank, given in the order of memory, are cut into consecutive rows; the
// result has the first item of each row, then the second of each row, and so on. So the tets of one batch are
// far apart, and the next batch needs data near those that the caches still hold. Sorting by exact lengths or
// qualities would make coarsening slower.
template <class Item>
std::vector<Item> in_order(std::vector<Item> items) {
  std::ranges::stable_sort(items, {}, &Item::rank);
  const std::size_t rows = std::clamp<std::size_t>(items.size() / items_per_row, 1, most_rows);
  std::vector<Item> ordered;
  ordered.reserve(items.size());
  for (auto first = items.begin(); first != items.end();) {
    const auto last = std::find_if(first, items.end(), [&](const Item& i) { return i.rank != first->rank; });
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t length = (count + rows - 1) / rows;
    for (std::size_t column = 0; column < length; ++column)
      for (std::size_t i = column; i < count; i += length)
        ordered.push_back(first[static_cast<std::ptrdiff_t>(i)]);
    first = last;
  }
  return ordered;
}

/// A run of coarsening: collapses edges, shortest first, and improves tets, worst first; both by rank. The
/// result does not depend on the number of threads.
class Coarsening {
 public:
  Coarsening(EditableMesh& edited, const MeshOptions& made_with, const Execution& execution)
      : edited_(edited),
        radius_edge_(made_with.bounds.radius_edge),
        metric_(target_sizes(mesh(), edited.plc, sizes_asked_for(made_with))),
        bounds_(edited.tet_bounds(made_with.bounds)),
        rule_(bounds_, made_with.bounds.radius_edge, metric_),
        changes_(mesh().points.size()),
        speculation_([this] { return Proposer(edited_, bounds_, radius_edge_, metric_, changes_); }),
        execution_(execution) {}

  // Returns the options without `edges_per_hole`, because it need not reduce target sizes: the CurveSlides
  // of the mesh keep enough edges at holes.
  static MeshOptions sizes_asked_for(MeshOptions options) {
    options.edges_per_hole = 0;
    return options;
  }

  CoarsenReport run() {
    const Stopwatch stopwatch;
    report_.tets_before = tets_ = complex().size();
    edited_.prepare();
    for (unsigned pass = 0; pass < plain_passes && !report_.cancelled; ++pass)
      if (!collapse_all(false)) break;
    // Whether a round begins with all vertices, not only with those at which something has changed: repairs
    // reach beyond the tets at a vertex, so changes farther away may have made more collapses possible.
    bool ask_all = false;
    for (unsigned round = 0; round < rounds && !report_.cancelled; ++round) {
      const bool settled = improve_all();
      const std::size_t before = tets_;
      if (ask_all) last_pass_ = last_repairs_ = 0;
      for (unsigned pass = 0; pass < repair_passes; ++pass)
        if (!collapse_all(true)) break;
      const bool is_done = settled && !worthwhile(before);
      if (is_done && (ask_all || report_.repaired * collapses_per_repair < report_.contracted_edges)) break;
      ask_all = is_done;
    }
    finish();
    report_.seconds = stopwatch.seconds();
    return report_;
  }

 private:
  const TetComplex& complex() const { return edited_.complex; }
  const TetMesh& mesh() const { return edited_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }

  struct Candidate {
    int rank;  // rank of the length of its shortest edge
    Index vertex;
    bool worth_repairs;
    std::size_t place = 0;  // in the order of trials
  };

  struct ShortEdge {
    double squared_length;  // in the metric
    Index end;
  };

  // Returns the vertices that have a short edge and have changed since the last pass or, if their collapses
  // may be repaired, since the last pass with repairs. Vertices with the shortest edges come first.
  std::vector<Candidate> find_candidates(bool repair) const {
    const std::uint32_t last = repair ? std::min(last_pass_, last_repairs_) : last_pass_;
    const auto ends = found_at_changed<ShortEdge>(last, [&](Index tet, std::vector<ShortEdge>& found) {
      if (complex()[tet].alive && changed_since(tet, last)) find_short_edges(tet, found);
    });
    std::vector<Candidate> candidates;
    for (const auto& [shortest, v] : shortest_of_each(ends)) {
      const bool repairs = repair && shortest < square(repaired_below);
      if (changes_.at(v) >= (repairs ? last_repairs_ : last_pass_))
        candidates.push_back({static_cast<int>(ranks_of_lengths * shortest), v, repairs});
    }
    candidates = in_order(std::move(candidates));
    for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i].place = i;
    return candidates;
  }

  // Returns each end once, with its shortest edge; sorted by end.
  std::vector<ShortEdge> shortest_of_each(std::vector<ShortEdge> edges) const {
    constexpr std::size_t points_per_edge = 16;
    const std::size_t points = mesh().points.size();
    std::vector<ShortEdge> found;
    if (edges.size() < points / points_per_edge) {
      std::ranges::sort(edges, {},
                        [](const ShortEdge& edge) { return std::pair(edge.end, edge.squared_length); });
      for (const ShortEdge& edge : edges)
        if (found.empty() || found.back().end != edge.end) found.push_back(edge);
      return found;
    }
    std::vector<double> shortest(points, INFINITY);
    for (const auto& [length, v] : edges) shortest[v] = std::min(shortest[v], length);
    for (Index v = 0; v < points; ++v)
      if (shortest[v] < INFINITY) found.push_back({shortest[v], v});
    return found;
  }

  // Adds the ends of a tet's short edges for which collapses are tried (`is_asked`), each with the squared
  // length of its edge in the metric.
  void find_short_edges(Index tet, std::vector<ShortEdge>& ends) const {
    constexpr double surely_long = (1 + 1e-9) * collapsed_below;
    const auto& v = complex()[tet].corners;
    const auto p = complex().corners(tet);
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      if (metric_.exceeds(surely_long, v[i], v[j], p[j] - p[i])) continue;
      const double length = metric_.squared_length(v[i], v[j], p[j] - p[i]);
      if (!is_short(length)) continue;
      for (const Index end : {v[i], v[j]})
        if (is_asked(end, length)) ends.push_back({length, end});
    }
  }

  // Returns whether to try collapses of a vertex with an edge of this squared length in the metric.
  bool is_asked(Index vertex, double length) const {
    const unsigned dimension = mesh().features[vertex].dimension;
    return dimension != 0 && (dimension < 3 || length < square(asked_inside_below));
  }

  // Tries every candidate once. Returns whether another pass is worthwhile.
  bool collapse_all(bool repair) {
    const std::vector<Candidate> candidates = find_candidates(repair);
    last_pass_ = changes_.advance();
    if (repair) last_repairs_ = last_pass_;
    chances_ = {};
    const std::size_t before = tets_;
    steps_ = 0;
    return speculation_.for_each<VertexProposal>(
               candidates, changes_,
               [&](Proposer& proposer, const Candidate& candidate, VertexProposal& found) {
                 propose(proposer, candidate, found);
               },
               [&](const Candidate& candidate, const VertexProposal& found, std::uint32_t begun) {
                 const bool lacks_repairs =
                     candidate.worth_repairs && !found.with_repairs && chances_.is_due(candidate.place);
                 return !lacks_repairs && changes_.at(candidate.vertex) < begun &&
                        !changes_.any_since(begun, found.read) && edited_.curve_can_spare(found.change) &&
                        std::ranges::all_of(found.to_repair, [&](const Change& change) {
                          return edited_.curve_can_spare(change);
                        });
               },
               [&](const Candidate& candidate, VertexProposal& found) {
                 if (stopped()) return false;
                 collapse(candidate, found);
                 return true;
               }) &&
           worthwhile(before);
  }

  void propose(Proposer& proposer, const Candidate& candidate, VertexProposal& found) const {
    const Index v = candidate.vertex;
    const bool repairs = candidate.worth_repairs && chances_.is_due(candidate.place);
    if (repairs)
      if (const auto looked_at = failed_.still_fails(v, changes_); !looked_at.empty()) {
        found = {};
        found.with_repairs = true;
        found.read.assign(looked_at.begin(), looked_at.end());
        return;
      }
    if (complex().in_use(v))
      proposer.collapses(v, repairs, found);
    else
      found = {};
    found.with_repairs = repairs;
  }

  bool worthwhile(std::size_t before) const {
    return static_cast<double>(tets_) < (1 - least_share) * static_cast<double>(before);
  }

  bool stopped() {
    if (execution_.cancelled()) report_.cancelled = true;
    if (++steps_ % steps_between_reports == 0 && execution_.progress &&
        !execution_.progress({"coarsen", 0, 0, tets_}))
      report_.cancelled = true;
    return report_.cancelled;
  }

  void collapse(const Candidate& candidate, VertexProposal& found) {
    const Index vertex = candidate.vertex;
    if (!found.change.is_none()) {
      forget_touched();
      apply(std::move(found.change));
      settle();
      ++report_.contracted_edges;
      return;
    }
    if (found.to_repair.empty() || !chances_.is_due(candidate.place)) return;
    looked_at_ = found.read;
    looked_at_.push_back(vertex);
    for (Change& change : found.to_repair)
      if (collapse_and_repair(std::move(change), found.floor)) return chances_.note_success();
    chances_.note_failure();
    // Record the failure only if it depends on nothing but the tets at `looked_at_`. A collapse on a curve
    // also depends on the number of the curve's edges; and a pinched vertex has tets that the trials did not
    // find.
    if (mesh().features[vertex].dimension > 1 &&
        std::ranges::none_of(looked_at_, [&](Index v) { return complex().pinched(v); }))
      failed_.note(vertex, looked_at_, changes_.now());
  }

  bool collapse_and_repair(Change change, double floor) {
    Trial trial(edited_);
    forget_touched();
    examined_.clear();
    const std::size_t before = tets_;
    rule_.set_mode(Mode::trial);
    for (unsigned step = 0; !change.is_none(); ++step) {
      apply_on_trial(std::move(change));
      const auto [count, worst] = tets_to_mend(floor);
      if (count == 0) {
        trial.keep();
        settle();
        ++report_.contracted_edges;
        ++report_.repaired;
        return true;
      }
      if (step + count > most_repairs + 1) break;
      examined_.insert(examined_.end(), complex()[worst].corners.begin(), complex()[worst].corners.end());
      change = speculation_.own().improvement_of(worst, Mode::trial);
    }
    look_at_touched();
    trial.undo();
    tets_ = before;
    look_at_examined();
    return false;
  }

  // Notes the corners of the mesh faces at tets that a trial made, because the faces around an edge also
  // decide whether it may be flipped in its patch.
  void look_at_touched() {
    for (const Index t : touched_)
      if (complex()[t].alive) look_at_faces(t);
  }

  // Notes the vertices that an undone trial examined, and the corners of the mesh faces of the tets there.
  void look_at_examined() {
    sort_uniquely(examined_);
    for (const Index v : examined_) {
      looked_at_.push_back(v);
      complex().star(v, star_);
      for (const Index t : star_) look_at_faces(t);
    }
    sort_uniquely(looked_at_);
  }

  void look_at_faces(Index tet) {
    const auto& of = complex()[tet];
    for (unsigned corner = 0; corner < 4; ++corner)
      if (of.faces[corner] != none)
        for (const Index v : side_corners(of.corners, corner)) looked_at_.push_back(v);
  }

  struct ToMend {
    std::size_t count = 0;
    Index worst = none;
  };
  // Returns the number of tets that a trial made or changed and that are below the floor or lack the
  // guarantee, and the worst of them.
  ToMend tets_to_mend(double floor) const {
    ToMend found;
    double least = INFINITY;
    for (const Index t : touched_) {
      if (!complex()[t].alive) continue;
      const double q = trial_qualities_[t];
      if (q >= 1 || (q >= floor && rule_.keeps_guarantee(complex().corners(t), complex()[t].corners, q)))
        continue;
      ++found.count;
      if (q >= least) continue;
      least = q;
      found.worst = t;
    }
    return found;
  }

  // Improves tets in sweeps. Returns false if even the last permitted sweep changed tets.
  bool improve_all() {
    for (unsigned sweep = 0; sweep < most_sweeps; ++sweep)
      if (!improve_once()) return true;
    return false;
  }

  bool improve_once() {
    rule_.set_mode(Mode::final);
    struct Poor {
      int rank;  // rank of its quality
      Index tet;
      double quality;
    };
    known_qualities_.resize(complex().size(), NAN);
    std::vector<Poor> all = found_at_changed<Poor>(last_sweep_, [&](Index t, std::vector<Poor>& found) {
      double& q = known_qualities_[t];
      if (std::isnan(q)) q = quality_if_improvable(t);
      if (q < improved_below && complex()[t].alive && changed_since(t, last_sweep_))
        found.push_back({rank_of_quality(q), t, q});
    });
    const auto by_place = [](const Poor& a, const Poor& b) { return a.tet < b.tet; };
    if (!std::ranges::is_sorted(all, by_place)) std::ranges::sort(all, by_place);
    const std::vector<Poor> poor = in_order(std::move(all));
    last_sweep_ = changes_.advance();
    bool any = false;
    steps_ = 0;
    speculation_.for_each<Change>(
        poor, changes_,
        [&](Proposer& proposer, const Poor& item, Change& change) {
          const Index t = item.tet;
          change = {};
          if (complex()[t].alive && quality(t) == item.quality)
            change = proposer.improvement_of(t, Mode::final);
        },
        [&](const Poor& item, const Change& change, std::uint32_t begun) {
          const auto untouched = [&](Index t) { return complex()[t].alive && !changed_since(t, begun); };
          return untouched(item.tet) && std::ranges::all_of(change.read, untouched);
        },
        [&](const Poor&, Change& change) {
          if (stopped()) return false;
          if (change.is_none()) return true;
          forget_touched();
          apply(std::move(change));
          settle();
          any = true;
          return true;
        });
    return any && !report_.cancelled;
  }

  // Returns the quality of a tet; infinity if it is removed or surely good enough.
  double quality_if_improvable(Index tet) const {
    if (!complex()[tet].alive ||
        rule_.surely_exceeds(improved_below, complex().corners(tet), complex()[tet].corners))
      return INFINITY;
    return quality(tet);
  }

  bool changed_since(Index tet, std::uint32_t when) const {
    return changes_.any_since(when, complex()[tet].corners);
  }

  // Calls `look(tet, found)` once, in any order, for each tet with a corner that has changed since this time,
  // and returns the items that it adds to `found`. If many vertices have changed, calls it for all tets.
  template <class Found, class Look>
  std::vector<Found> found_at_changed(std::uint32_t since, const Look& look) const {
    const std::optional<std::vector<Index>> vertices = few_changed(since);
    if (!vertices)
      return found_in_ranges<Found>(complex().size(), [&](std::size_t i, std::vector<Found>& found) {
        look(static_cast<Index>(i), found);
      });
    constexpr std::size_t at_once = 128;
    std::vector<std::vector<Found>> parts((vertices->size() + at_once - 1) / at_once);
    parallel_for_ranges(vertices->size(), at_once, [&](std::size_t first, std::size_t last) {
      std::vector<Index> star;
      for (std::size_t i = first; i < last; ++i) {
        const Index vertex = (*vertices)[i];
        complex().star(vertex, star);
        for (const Index t : star)
          if (first_changed(t, since) == vertex) look(t, parts[first / at_once]);
      }
    });
    std::vector<Found> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  // Returns the smallest index of a corner that has changed since this time; none if no corner has.
  Index first_changed(Index tet, std::uint32_t since) const {
    Index first = none;
    for (const Index v : complex()[tet].corners)
      if (changes_.at(v) >= since) first = std::min(first, v);
    return first;
  }

  // Returns the vertices that have changed since this time and still have tets. Returns nothing if the log
  // does not reach back so far, because many have changed, or if one of the vertices is pinched.
  std::optional<std::vector<Index>> few_changed(std::uint32_t since) const {
    if (since < log_begins_) return std::nullopt;
    const auto first =
        std::ranges::partition_point(log_, [&](const Changed& changed) { return changed.when < since; });
    std::vector<Index> vertices;
    for (auto changed = first; changed != log_.end(); ++changed)
      if (complex().in_use(changed->vertex)) vertices.push_back(changed->vertex);
    sort_uniquely(vertices);
    if (std::ranges::any_of(vertices, [&](Index v) { return complex().pinched(v); })) return std::nullopt;
    return vertices;
  }

  const std::vector<Index>& apply(Change change) {
    tets_ -= change.replacement.old.size();
    tets_ += change.replacement.created.size();
    // A corner of a removed tet may be in none of the new tets.
    for (const Index t : change.replacement.old) {
      const auto& v = complex()[t].corners;
      touched_vertices_.insert(touched_vertices_.end(), v.begin(), v.end());
    }
    const auto& changed = edited_.apply(std::move(change));
    touched_.insert(touched_.end(), changed.begin(), changed.end());
    return changed;
  }

  void apply_on_trial(Change change) {
    const auto& changed = apply(std::move(change));
    if (trial_qualities_.size() < complex().size()) trial_qualities_.resize(complex().size());
    for (const Index t : changed) trial_qualities_[t] = quality(t);
  }

  void forget_touched() {
    touched_.clear();
    touched_vertices_.clear();
  }

  // Records the changes since `forget_touched`. Precondition: they are final, not on trial.
  void settle() {
    changes_.advance();
    if (log_.size() > complex().size() / tets_per_logged_change) {
      log_.clear();
      log_begins_ = changes_.now();
    }
    for (const Index v : touched_vertices_) note_change(v);
    known_qualities_.resize(complex().size(), NAN);
    for (const Index t : touched_) {
      known_qualities_[t] = NAN;
      if (complex()[t].alive)
        for (const Index v : complex()[t].corners) note_change(v);
    }
  }

  void note_change(Index vertex) {
    if (changes_.at(vertex) == changes_.now()) return;
    changes_.note(vertex);
    log_.push_back({changes_.now(), vertex});
  }

  // Drops the collars' balls, because coarsening has changed their cells.
  void finish() {
    edited_.complex.forget_balls();
    report_.tets_after = tets_;
  }

  EditableMesh& edited_;
  double radius_edge_;
  Metric metric_;
  TetBounds bounds_;
  CoarseningRule rule_;
  ChangeTimes changes_;
  OrderedSpeculation<Proposer> speculation_;
  const Execution& execution_;
  std::size_t tets_ = 0, steps_ = 0;
  std::uint32_t last_pass_ = 0, last_repairs_ = 0;  // when the last pass of any kind, and the last one with
                                                    // repairs, began
  std::uint32_t last_sweep_ = 0;                    // when the last sweep of improvement began
  struct Changed {
    std::uint32_t when;
    Index vertex;
  };
  std::vector<Changed> log_;             // the latest changes reported to `changes_`, by time
  std::uint32_t log_begins_ = 1;         // the time from which the log is complete
  std::vector<Index> touched_;           // tets made or changed since `forget_touched`
  std::vector<Index> touched_vertices_;  // vertices of tets removed since then
  std::vector<Index> examined_;          // corners of the tets that a trial tried to improve
  std::vector<Index> looked_at_;         // vertices whose tets the trials of one vertex examined
  std::vector<Index> star_;
  FailedRepairs failed_;
  RepairChances chances_;
  std::vector<double> trial_qualities_;  // by tet, for tets that a trial changed
  std::vector<double> known_qualities_;  // by tet; infinite where good enough, NaN if not known
  CoarsenReport report_;
};

}  // namespace
}  // namespace remeshing::coarsening

CoarsenReport coarsen(remeshing::EditableMesh& edited, const MeshOptions& made_with,
                      const Execution& execution) {
  if (!(made_with.bounds.thin_angle > 0 && made_with.bounds.thin_angle <= largest_thin_angle))
    throw OptionError(
        fmt::format("Bounds::thin_angle must be above 0 and at most {} degrees", largest_thin_angle));
  if (!(made_with.bounds.reserve >= 0 && made_with.bounds.reserve <= largest_reserve))
    throw OptionError(fmt::format("Bounds::reserve must be from 0 to {}", largest_reserve));
  return remeshing::coarsening::Coarsening(edited, made_with, execution).run();
}

CoarsenReport coarsen(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with,
                      const Execution& execution) {
  assert(mesh.order() == 1);
  const SurfaceTolerance tolerance = tolerance_of(plc, made_with.bounds, made_with.size);
  CoarsenReport report;
  ThreadLimit(made_with.threads).run([&] {
    remeshing::EditableMesh edited(mesh, plc, tolerance, made_with.edges_per_hole,
                                   made_with.bounds.lower_where_forced);
    report = coarsen(edited, made_with, execution);
    edited.store_marked(made_with.bounds);
  });
  return report;
}

}  // namespace collarmesh
