#include "collarmesh/improve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <queue>

#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "common/found_in_ranges.h"
#include "common/parallel_for.h"
#include "common/shared_bounds.h"
#include "common/stopwatch.h"
#include "common/thread_limit.h"
#include "improve/detours.h"
#include "improve/improve_edited.h"
#include "improve/operation_chooser.h"
#include "remesh/operations.h"
#include "remesh/ordered_speculation.h"

namespace collarmesh {

namespace remeshing::improvement {
namespace {

// Changes are proposed for one in this many tets at a time: so few that a change rarely touches another one.
constexpr std::size_t tets_per_proposal = 2000;
constexpr std::size_t most_proposals = 1024;
constexpr std::size_t steps_between_reports = 1024;
// The least relative gain in quality for which a vertex is moved. Tets at walls stay poor however often their
// vertices move a little, so small gains do not pay. In detours, which work on few tets, they may help.
constexpr double least_gain = 0.02, least_gain_in_detours = 1e-3;
// Detours are taken if at most `few` tets, plus one in `tets_per_few` of all tets, need them; with more such
// tets the wanted quality is out of reach.
constexpr std::size_t few = 50, tets_per_few = 50;
// Largest number of operations to try in detours: `trials`, plus one for each `tets_per_trial` tets.
constexpr std::size_t trials = 4000, tets_per_trial = 50;

/// A run of improvement: improves the tets below the wanted quality, worst first. Several threads propose
/// changes for a batch of the worst tets. Then one thread makes the changes, one after the other; a tet whose
/// proposal depends on tets that have changed since waits for a later batch. So the result does not depend on
/// the number of threads.
class Improvement {
 public:
  Improvement(EditableMesh& edited, const ImproveOptions& options, const Execution& execution,
              bool thoroughly)
      : edited_(edited),
        bounds_(edited.tet_bounds(options.bounds)),
        rule_(options.bounds.radius_edge, options.bounds.thin_angle > 0 ? &bounds_.thin : nullptr,
              options.bounds.thin_angle > 0 ? &bounds_.cells : nullptr),
        chooser_(edited, rule_, options, thoroughly),
        speculation_([this] { return Operations(edited_, rule_); }),
        execution_(execution),
        detours_(thoroughly && options.move_vertices),
        passes_(options.passes) {}

  ImproveReport run() {
    const Stopwatch stopwatch;
    rule_.set_least_gain(least_gain);
    find_poor_tets();
    report_.candidates = poor_.size();
    for (unsigned pass = 0; pass < passes_ && !poor_.empty() && !report_.cancelled; ++pass) {
      const std::size_t before = changes();
      const std::uint32_t begun = changes_.now();
      work_off();
      if (changes() == before) break;
      find_poor_tets_again(begun);
    }
    if (detours_ && !report_.cancelled && take_detours()) find_poor_tets();
    report_.remaining = poor_.size();
    report_.seconds = stopwatch.seconds();
    return report_;
  }

 private:
  struct Item {
    double quality;
    Index tet;
    std::uint32_t generation;

    friend bool operator<(const Item& a, const Item& b) {  // puts the worst tet on top
      return a.quality != b.quality ? a.quality > b.quality : a.tet > b.tet;
    }
  };

  const TetComplex& complex() const { return edited_.complex; }

  std::size_t changes() const {
    return report_.edge_removals + report_.boundary_flips + report_.moved_vertices +
           report_.inserted_vertices + report_.contracted_edges;
  }

  void find_poor_tets() {
    poor_ = found_in_ranges<Item>(complex().size(), [&](std::size_t t, std::vector<Item>& found) {
      add_if_poor(static_cast<Index>(t), found);
    });
  }

  // Finds all poor tets like find_poor_tets, but looks only at those in `poor_` and those changed in batches
  // after `batch`. Preconditions: no other tets have changed since `poor_` was found; `poor_` is sorted by
  // tet.
  void find_poor_tets_again(std::uint32_t batch) {
    assert(std::ranges::is_sorted(poor_, {}, &Item::tet));
    std::vector<Index> asked;
    auto poor = poor_.begin();
    for (Index t = 0; t < complex().size(); ++t) {
      const bool was_poor = poor != poor_.end() && poor->tet == t;
      if (was_poor) ++poor;
      if (was_poor || (t < changed_in_.size() && changed_in_[t] > batch)) asked.push_back(t);
    }
    poor_ = found_in_ranges<Item>(
        asked.size(), [&](std::size_t i, std::vector<Item>& found) { add_if_poor(asked[i], found); });
  }

  void add_if_poor(Index tet, std::vector<Item>& found) const {
    const double q = chooser_.poor_quality(tet);
    if (q < INFINITY) found.push_back({q, tet, complex()[tet].generation});
  }

  void queue(Index tet) {
    const double q = chooser_.poor_quality(tet);
    if (q < INFINITY) queue_.push({q, tet, complex()[tet].generation});
  }

  bool is_up_to_date(const Item& item) const {
    const auto& tet = complex()[item.tet];
    return tet.alive && tet.generation == item.generation &&
           chooser_.quality(item.tet) == item.quality;  // if not, a vertex has moved since
  }

  void work_off() {
    for (const Item& item : poor_) queue_.push(item);
    const std::size_t size = std::clamp<std::size_t>(complex().size() / tets_per_proposal, 1, most_proposals);
    std::size_t steps = 0;
    while (!queue_.empty()) {
      batch_.clear();
      while (!queue_.empty() && batch_.size() < size) {
        if (is_up_to_date(queue_.top())) batch_.push_back(queue_.top());
        queue_.pop();
      }
      const std::size_t reports = steps / steps_between_reports;
      steps += batch_.size();
      if (steps / steps_between_reports > reports && stopped()) {
        report_.cancelled = true;
        return;
      }
      proposals_.resize(batch_.size());
      speculation_.propose_all(batch_, proposals_, [&](Operations& own, const Item& item, Change& change) {
        change = is_known_to_fail(item.tet) ? Change{} : chooser_.propose(own, item.tet);
      });
      changes_.advance();
      changed_in_.resize(complex().size(), 0);
      for (std::size_t i = 0; i < batch_.size(); ++i)
        if (proposals_[i].is_none()) nothing_helps(batch_[i].tet);
      for (std::size_t i = 0; i < batch_.size(); ++i) {
        if (is_untouched(proposals_[i]))
          apply(std::move(proposals_[i]));
        else if (is_up_to_date(batch_[i]))
          queue_.push(batch_[i]);
      }
    }
  }

  bool stopped() const {
    return execution_.cancelled() ||
           (execution_.progress &&
            !execution_.progress({"improve", 0, complex().mesh().points.size(), complex().size()}));
  }

  void nothing_helps(Index tet) {
    chooser_.nothing_helps(tet);
    failed_in_.resize(complex().size(), 0);
    failed_in_[tet] = changes_.now();
  }

  // Returns whether nothing helped this tet when it was last tried, and none of the tets on which a proposal
  // may depend has changed since: those at its corners and at the neighbours of the corners.
  bool is_known_to_fail(Index tet) const {
    if (tet >= failed_in_.size() || failed_in_[tet] == 0) return false;
    const auto is_old = [&](Index v) { return !complex().pinched(v) && changes_.at(v) < failed_in_[tet]; };
    std::vector<Index> around;
    return std::ranges::all_of(complex()[tet].corners, [&](Index corner) {
      if (!is_old(corner)) return false;
      complex().star(corner, around);
      return std::ranges::all_of(around,
                                 [&](Index t) { return std::ranges::all_of(complex()[t].corners, is_old); });
    });
  }

  void note_change_at(Index tet) {
    changes_.resize(complex().mesh().points.size());
    for (const Index v : complex()[tet].corners) changes_.note(v);
  }

  // Tries detours if few enough poor tets need them. Returns whether it did; if not, `poor_` stays up to
  // date. Precondition: `poor_` is up to date.
  bool take_detours() {
    assert(std::ranges::all_of(poor_, [this](const Item& item) { return is_up_to_date(item); }));
    std::vector<Index> poor;
    for (const Item& item : poor_) poor.push_back(item.tet);
    const auto may_change = [this](Index t) { return chooser_.may_change_vertices(t); };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(poor, may_change));
    if (count == 0 || count > few + complex().size() / tets_per_few) return false;
    edited_.prepare();
    rule_.set_least_gain(least_gain_in_detours);
    chooser_.forget();
    Detours detours(edited_, chooser_, speculation_.own(), trials + complex().size() / tets_per_trial);
    report_.detours = detours.take_all(std::move(poor), [this] { return report_.cancelled = stopped(); });
    return true;
  }

  // Returns whether the tets that the change replaces, and the tets that were read to propose it, are as they
  // were when the batch began. The change depends on nothing else: places of corners, mesh faces, samples and
  // curve edges only change with the tets there. This requires complete stars, so no change is proposed at
  // pinched vertices.
  bool is_untouched(const Change& change) const {
    const auto untouched = [&](Index t) { return complex()[t].alive && changed_in_[t] != changes_.now(); };
    return std::ranges::all_of(change.replacement.old, untouched) &&
           std::ranges::all_of(change.read, untouched);
  }

  void apply(Change change) {
    switch (change.kind) {
      case Change::Kind::none: return;
      case Change::Kind::edge_removal: ++report_.edge_removals; break;
      case Change::Kind::boundary_flip: ++report_.boundary_flips; break;
      case Change::Kind::move: ++report_.moved_vertices; break;
      case Change::Kind::collapse:
        if (!edited_.curve_can_spare(change)) return;
        ++report_.contracted_edges;
        break;
      case Change::Kind::insertion:
        if (report_.inserted_vertices >= report_.candidates) return;
        ++report_.inserted_vertices;
        break;
    }
    for (const Index t : change.replacement.old) note_change_at(t);
    for (const Index t : edited_.apply(std::move(change))) {
      if (t >= changed_in_.size()) changed_in_.resize(complex().size(), 0);
      changed_in_[t] = changes_.now();
      if (t < failed_in_.size()) failed_in_[t] = 0;
      note_change_at(t);
      chooser_.changed(t);
      queue(t);
    }
  }

  EditableMesh& edited_;
  TetBounds bounds_;
  SliverRule rule_;
  OperationChooser chooser_;
  ChangeTimes changes_{complex().mesh().points.size()};  // the time is the number of the batch
  OrderedSpeculation<Operations> speculation_;
  const Execution& execution_;
  bool detours_;
  unsigned passes_;
  std::vector<Item> poor_;  // poor tets, as found by find_poor_tets
  std::priority_queue<Item> queue_;
  std::vector<Item> batch_;
  std::vector<Change> proposals_;
  std::vector<std::uint32_t> changed_in_;  // by tet: the batch that changed it last
  std::vector<std::uint32_t> failed_in_;   // by tet: the batch in which nothing helped it; 0: none
  ImproveReport report_;
};

}  // namespace
}  // namespace remeshing::improvement

ImproveOptions improve_options(unsigned level) {
  ImproveOptions options;
  switch (level) {
    case 1: options.min_dihedral = 15, options.move_vertices = false, options.passes = 1; break;
    case 2: break;
    case 3: options.min_dihedral = 30, options.passes = 6; break;
    default:
      throw OptionError(fmt::format("the level of improvement must be from 1 to {}", highest_improve_level));
  }
  return options;
}

ImproveReport improve(remeshing::EditableMesh& edited, const ImproveOptions& options,
                      const Execution& execution, bool thoroughly) {
  return remeshing::improvement::Improvement(edited, options, execution, thoroughly).run();
}

ImproveReport improve(TetMesh& mesh, const Plc& plc, const ImproveOptions& options,
                      const Execution& execution) {
  assert(mesh.order() == 1);
  ImproveReport report;
  ThreadLimit(options.threads).run([&] {
    remeshing::EditableMesh edited(mesh, plc, options.bounds, options.edges_per_hole);
    report = improve(edited, options, execution);
    if (options.bounds.thin_angle > 0)
      edited.store_marked(options.bounds);
    else
      edited.store();
  });
  return report;
}

}  // namespace collarmesh
