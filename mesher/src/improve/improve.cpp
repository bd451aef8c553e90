#include "collarmesh/improve.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <queue>

#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "common/parallel_for.h"
#include "improve/improve_workpiece.h"
#include "improve/operations.h"
#include "thread_limit.h"

namespace collarmesh {

namespace improvement {
namespace {

// An inserted vertex has to bring the tets around it to this share of the wanted quality.
constexpr double enough = 0.7;
// Changes are proposed for so many tets at once: few of all, so that they hardly meet.
constexpr std::size_t tets_per_proposal = 2000;
constexpr std::size_t most_proposals = 1024;
constexpr std::size_t steps_between_reports = 1024;

/// Works on the tets below a quality, worst first. Changes are proposed for the worst few of them at once, by
/// several threads, and made one after the other; what met an earlier one is proposed again. So the result
/// does not depend on the number of threads.
class Improvement {
 public:
  Improvement(Workpiece& workpiece, const ImproveOptions& options, const Execution& execution)
      : workpiece_(workpiece),
        thin_(workpiece.plc, complex().mesh(), options.thin_angle, options.thin_reserve),
        rule_(options.radius_edge, options.thin_angle > 0 ? &thin_ : nullptr),
        operations_([this] { return Operations(workpiece_, rule_); }),
        execution_(execution),
        move_vertices_(options.move_vertices),
        keep_vertices_(options.keep_vertices),
        wanted_(std::sin(options.min_dihedral * std::numbers::pi / 180)),
        passes_(options.passes) {}

  ImproveReport run() {
    const auto started = std::chrono::steady_clock::now();
    queue_all();
    report_.candidates = queue_.size();
    for (unsigned pass = 0; pass < passes_ && !queue_.empty() && !report_.cancelled; ++pass) {
      const std::size_t before = changes();
      work_off();
      if (changes() == before) break;
      queue_all();
    }
    const std::vector<double> all = qualities();
    report_.remaining = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [this](double q) { return q < wanted_; }));
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return report_;
  }

 private:
  struct Item {
    double quality;
    Index tet;
    std::uint32_t generation;

    friend bool operator<(const Item& a, const Item& b) {  // the worst on top
      return a.quality != b.quality ? a.quality > b.quality : a.tet > b.tet;
    }
  };

  const TetComplex& complex() const { return workpiece_.complex; }

  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }

  std::size_t changes() const {
    return report_.edge_removals + report_.boundary_flips + report_.moved_vertices +
           report_.inserted_vertices + report_.contracted_edges;
  }

  // Infinite for what is not to be improved.
  std::vector<double> qualities() const {
    std::vector<double> all(complex().size(), INFINITY);
    parallel_for(all.size(), [&](std::size_t i) {
      const auto t = static_cast<Index>(i);
      if (complex()[t].alive && !complex()[t].collar) all[t] = quality(t);
    });
    return all;
  }

  void queue_all() {
    const std::vector<double> all = qualities();
    for (Index t = 0; t < complex().size(); ++t)
      if (all[t] < wanted_) queue_.push({all[t], t, complex()[t].generation});
  }

  void queue(Index tet) {
    if (!complex()[tet].alive || complex()[tet].collar) return;
    const double q = quality(tet);
    if (q < wanted_) queue_.push({q, tet, complex()[tet].generation});
  }

  bool is_up_to_date(const Item& item) const {
    const auto& tet = complex()[item.tet];
    return tet.alive && tet.generation == item.generation &&
           quality(item.tet) == item.quality;  // else a vertex has moved since
  }

  void work_off() {
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
      proposals_.assign(batch_.size(), {});
      parallel_for(batch_.size(),
                   [&](std::size_t i) { proposals_[i] = propose(operations_.local(), batch_[i].tet); });
      ++batch_number_;
      changed_in_.resize(complex().size(), 0);
      for (std::size_t i = 0; i < batch_.size(); ++i)
        if (proposals_[i].kind == Change::Kind::none) set_stays(batch_[i].tet, move_vertices_);
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

  // The first that helps of: an edge removed, a corner moved, an edge contracted, a vertex inserted.
  Change propose(Operations& operations, Index tet) const {
    Change change;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) operations.remove_edge(tet, i, j, change);
    const auto& corners = complex()[tet].corners;
    const auto found = [&] { return change.kind != Change::Kind::none; };
    if (found() || !move_vertices_) return change;
    for (const Index v : corners)
      if (!stays(v)) operations.move_vertex(v, change);
    if (found() || !may_change_vertices(tet)) return change;
    for (const Index v : corners)
      for (const Index w : corners)
        if (v != w) operations.contract_edge(v, w, change);
    for (unsigned i = 0; i < 4 && !found(); ++i)
      for (unsigned j = i + 1; j < 4 && !found(); ++j)
        operations.split_edge(corners[i], corners[j], enough * wanted_, change);
    return change;
  }

  // Whether a move helps depends on the tets at the vertex alone, each of which may ask.
  bool stays(Index vertex) const { return vertex < stays_.size() && stays_[vertex]; }
  void set_stays(Index tet, bool stays) {
    stays_.resize(complex().mesh().points.size(), false);
    for (const Index v : complex()[tet].corners) stays_[v] = stays;
  }

  // In a coarsened mesh walls are one element thick and tets at them poor for that; vertices would bring
  // back what has been removed. So only tets beyond the largest angle of thin ones may change their number
  // there, and all where no thin tet is near. (Judged when the batch begins, whatever it changes.)
  bool may_change_vertices(Index tet) const {
    if (!keep_vertices_ || rule_.is_blunt(quality(tet))) return true;
    std::vector<Index> star;
    for (const Index v : complex()[tet].corners) {
      complex().star(v, star);
      for (const Index t : star)
        if (!rule_.is_within_bound(complex().corners(t))) return false;
    }
    return true;
  }

  // Is all that the change depends on as it was when the batch was begun? That is in the tets that it
  // replaces or has read, with their corners' places and the mesh' faces, samples and curve edges there,
  // since stars are complete: nothing is proposed where they are not.
  bool is_untouched(const Change& change) const {
    const auto untouched = [&](Index t) { return complex()[t].alive && changed_in_[t] != batch_number_; };
    return std::all_of(change.replacement.old.begin(), change.replacement.old.end(), untouched) &&
           std::all_of(change.read.begin(), change.read.end(), untouched);
  }

  void apply(Change change) {
    switch (change.kind) {
      case Change::Kind::none: return;
      case Change::Kind::edge_removal: ++report_.edge_removals; break;
      case Change::Kind::boundary_flip: ++report_.boundary_flips; break;
      case Change::Kind::move: ++report_.moved_vertices; break;
      case Change::Kind::contraction:
        if (!workpiece_.curve_can_spare(change)) return;  // another one took the curve's last edge to spare
        ++report_.contracted_edges;
        break;
      case Change::Kind::insertion:
        if (report_.inserted_vertices >= report_.candidates) return;
        ++report_.inserted_vertices;
        break;
    }
    for (const Index t : workpiece_.apply(std::move(change))) {
      if (t >= changed_in_.size()) changed_in_.resize(complex().size(), 0);
      changed_in_[t] = batch_number_;
      set_stays(t, false);
      queue(t);
    }
  }

  Workpiece& workpiece_;
  ThinShape thin_;
  SliverRule rule_;
  tbb::enumerable_thread_specific<Operations> operations_;
  const Execution& execution_;
  bool move_vertices_, keep_vertices_;
  double wanted_;
  unsigned passes_;
  std::priority_queue<Item> queue_;
  std::vector<Item> batch_;
  std::vector<Change> proposals_;
  std::uint32_t batch_number_ = 0;
  std::vector<std::uint32_t> changed_in_;  // the batch that changed a tet last
  std::vector<bool> stays_;  // by vertex: no move of it helps, and nothing at it has changed since
  ImproveReport report_;
};

}  // namespace
}  // namespace improvement

ImproveOptions improve_options(unsigned level) {
  ImproveOptions options;
  switch (level) {
    case 1: options.min_dihedral = 15, options.move_vertices = false, options.passes = 1; break;
    case 2: break;
    case 3: options.min_dihedral = 30, options.passes = 6; break;
    default: throw OptionError("the level of improvement must be 1, 2 or 3");
  }
  return options;
}

ImproveReport improve(improvement::Workpiece& workpiece, const ImproveOptions& options,
                      const Execution& execution) {
  return improvement::Improvement(workpiece, options, execution).run();
}

ImproveReport improve(TetMesh& mesh, const Plc& plc, const ImproveOptions& options,
                      const Execution& execution) {
  const double distance =
      options.distance > 0 ? options.distance : default_distance(0, plc.bounds.diagonal());
  ImproveReport report;
  ThreadLimit(options.threads).run([&] {
    improvement::Workpiece workpiece(mesh, plc, distance, options.edges_per_hole);
    report = improve(workpiece, options, execution);
    workpiece.complex.store();
    if (options.thin_angle > 0) improvement::mark_thin_tets(mesh, options.radius_edge);
  });
  return report;
}

}  // namespace collarmesh
