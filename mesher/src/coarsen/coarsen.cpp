#include "collarmesh/coarsen.h"

#include <algorithm>
#include <chrono>
#include <queue>
#include <unordered_map>

#include "coarsen/coarsening_rule.h"
#include "coarsen/target_sizes.h"
#include "collarmesh/error.h"
#include "improve/operations.h"

namespace collarmesh {

namespace coarsening {
namespace {

using improvement::Change;
using improvement::Operations;
using improvement::TetComplex;
using improvement::ThinShape;
using improvement::Workpiece;
using Mode = CoarseningRule::Mode;

constexpr double default_distance = 1e-3;  // of the diagonal
// By the target length: edges below the first are contracted, no new one is above the second.
constexpr double contracted_below = 0.7, longest_new = 1.4;
constexpr unsigned plain_passes = 2, repair_passes = 2;
// A contraction that makes nothing worse than this may be repaired, in so many steps.
constexpr double repairable = 0.05;
constexpr unsigned most_repairs = 12;
// Tets below this quality are improved between the passes.
constexpr double improved_below = 1.3;
// A pass that removes a smaller share of the tets is the last.
constexpr double worthwhile = 0.005;
constexpr std::size_t steps_between_reports = 4096;

class Coarsening {
 public:
  Coarsening(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with, const CoarsenOptions& options,
             const Execution& execution)
      : workpiece_(mesh, plc,
                   made_with.distance > 0 ? made_with.distance : default_distance * plc.bounds.diagonal()),
        radius_edge_(made_with.radius_edge),
        sizes_(target_sizes(mesh, plc, made_with)),
        thin_(plc, mesh, options.thin_angle),
        rule_(thin_, made_with.radius_edge, sizes_),
        operations_(workpiece_, rule_),
        execution_(execution),
        changed_(mesh.points.size(), 0) {}

  CoarsenReport run() {
    const auto started = std::chrono::steady_clock::now();
    report_.tets_before = tets_ = complex().size();
    workpiece_.prepare();
    for (unsigned pass = 0; pass < plain_passes && !report_.cancelled; ++pass) contract_all(false);
    for (unsigned pass = 0; pass < repair_passes && !report_.cancelled; ++pass) {
      improve_all();
      const std::size_t before = tets_;
      contract_all(true);
      if (static_cast<double>(before - tets_) < worthwhile * static_cast<double>(before)) break;
    }
    if (!report_.cancelled) improve_all();
    store();
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return report_;
  }

 private:
  struct Candidate {
    double squared_relative_length;
    Index a, b;

    friend bool operator<(const Candidate& x, const Candidate& y) {  // the shortest on top
      if (x.squared_relative_length != y.squared_relative_length)
        return x.squared_relative_length > y.squared_relative_length;
      return std::pair(x.a, x.b) > std::pair(y.a, y.b);
    }
    friend bool operator==(const Candidate&, const Candidate&) = default;
  };

  const TetComplex& complex() const { return workpiece_.complex; }
  const TetMesh& mesh() const { return workpiece_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }

  double squared_relative_length(Index a, Index b) const {
    return rule_.squared_relative_length(squared_distance(mesh().points[a], mesh().points[b]), a, b);
  }

  void queue_short_edges(Index tet) {
    const auto& v = complex()[tet].corners;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) {
        const double length = squared_relative_length(v[i], v[j]);
        if (length < contracted_below * contracted_below)
          found_.push_back({length, std::min(v[i], v[j]), std::max(v[i], v[j])});
      }
  }

  void queue_found() {
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    for (const Candidate& c : found_) queue_.push(c);
    found_.clear();
  }

  void contract_all(bool repair) {
    for (Index t = 0; t < complex().size(); ++t)
      if (complex()[t].alive) queue_short_edges(t);
    queue_found();
    for (std::size_t steps = 1; !queue_.empty(); ++steps) {
      if (steps % steps_between_reports == 0 && stopped()) {
        report_.cancelled = true;
        queue_ = {};
        return;
      }
      const Candidate c = queue_.top();
      queue_.pop();
      if (!complex().in_use(c.a) || !complex().in_use(c.b)) continue;
      if (squared_relative_length(c.a, c.b) != c.squared_relative_length) continue;
      if (!was_tried(c, repair)) contract_edge(c, repair);
    }
  }

  bool stopped() const {
    return execution_.cancelled() || (execution_.progress && !execution_.progress({"coarsen", 0, 0, tets_}));
  }

  // In vain, and nothing has changed there since?
  bool was_tried(const Candidate& c, bool repair) {
    const std::uint64_t key = (std::uint64_t{c.a} << 32 | c.b);
    std::uint32_t& when = tried_[repair ? 1 : 0][key];
    if (when > 0 && changed_[c.a] < when && changed_[c.b] < when) return true;
    when = ++clock_;
    return false;
  }

  void contract_edge(const Candidate& c, bool repair) {
    const auto& features = mesh().features;
    const bool swapped = features[c.a].dimension < features[c.b].dimension;
    const Index first = swapped ? c.b : c.a, second = swapped ? c.a : c.b;
    const bool either = features[c.a].dimension == features[c.b].dimension;
    if (contract(first, second) || (either && contract(second, first))) return;
    if (!repair) return;
    if (contract_and_repair(first, second) || !either) return;
    contract_and_repair(second, first);
  }

  bool contract(Index vertex, Index onto) {
    rule_.set_mode(Mode::final);
    rule_.limit_lengths(0, INFINITY);  // those of new edges are looked at here
    if (!operations_.begin_contractions(vertex) || !lengths_fit(vertex, onto)) return false;
    Change change;
    operations_.contract_onto(onto, 0, 1, change);
    if (change.kind == Change::Kind::none) return false;
    touched_.clear();
    apply(std::move(change));
    settle();
    ++report_.contracted_edges;
    return true;
  }

  // Of the edges that a contraction makes. None may be longer than what is wanted, unless it takes the
  // place of one as long, or shorter than what there is around.
  bool lengths_fit(Index vertex, Index onto) {
    const auto& points = mesh().points;
    bool joined = false;
    ends_.clear();
    for (const Index t : operations_.tets_at_vertex()) {
      const auto& v = complex()[t].corners;
      const bool at_edge = std::find(v.begin(), v.end(), onto) != v.end();
      joined = joined || at_edge;
      for (const Index w : v)
        if (w != vertex && w != onto) ends_.emplace_back(w, !at_edge);
    }
    if (!joined) return false;
    std::sort(ends_.begin(), ends_.end());
    double shortest = squared_distance(points[vertex], points[onto]), longest = 0, created = INFINITY;
    Index last = none;
    for (const auto& [end, is_new] : ends_) {
      if (end == last) continue;  // one beside the edge comes first
      last = end;
      const double before = squared_distance(points[vertex], points[end]);
      shortest = std::min(shortest, before);
      longest = std::max(longest, rule_.squared_relative_length(before, vertex, end));
      if (!is_new) continue;
      const double after = squared_distance(points[onto], points[end]);
      created = std::min(created, after);
      if (after > before && rule_.squared_relative_length(after, onto, end) > longest_new * longest_new)
        return false;
    }
    shortest_ = std::sqrt(shortest);
    longest_ = std::max(longest_new, std::sqrt(longest));
    return created >= shortest;
  }

  bool contract_and_repair(Index vertex, Index onto) {
    rule_.set_mode(Mode::final);
    if (!operations_.begin_contractions(vertex) || !lengths_fit(vertex, onto)) return false;
    const double floor = std::min(1.0, operations_.worst_at_vertex());
    rule_.set_mode(Mode::force);
    Change change;
    operations_.contract_onto(onto, repairable, -INFINITY, change);
    if (change.kind == Change::Kind::none) return false;
    workpiece_.begin_trial();
    touched_.clear();
    const std::size_t before = tets_;
    apply(std::move(change));
    rule_.set_mode(Mode::trial);
    rule_.limit_lengths(shortest_, longest_);
    for (unsigned step = 0;; ++step) {
      const Index worst = worst_touched(floor);
      if (worst == none) {
        workpiece_.keep();
        settle();
        ++report_.contracted_edges;
        ++report_.repaired;
        return true;
      }
      if (step == most_repairs || !improve_tet(worst)) break;
    }
    workpiece_.undo();
    tets_ = before;
    return false;
  }

  // Among the tets that a trial made or changed: one that must not stay.
  Index worst_touched(double floor) const {
    Index worst = none;
    double least = INFINITY;
    for (const Index t : touched_) {
      if (!complex()[t].alive) continue;
      const double q = quality(t);
      const bool poor = q < floor || (q < 1 && !rule_.keeps_guarantee(complex().corners(t), q));
      if (!poor || q >= least) continue;
      least = q;
      worst = t;
    }
    return worst;
  }

  // By the first that helps of: an edge removed, a corner moved.
  bool improve_tet(Index tet) {
    const auto corners = complex()[tet].corners;
    Change change;
    const auto found = [&] { return change.kind != Change::Kind::none; };
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = i + 1; j < 4; ++j) operations_.remove_edge(tet, i, j, change);
    for (unsigned i = 0; i < 4 && !found(); ++i) operations_.move_vertex(corners[i], change);
    if (!found()) return false;
    apply(std::move(change));
    return true;
  }

  void improve_all() {
    rule_.set_mode(Mode::final);
    rule_.limit_lengths(0, longest_new);
    std::vector<std::pair<double, Index>> poor;
    for (Index t = 0; t < complex().size(); ++t)
      if (complex()[t].alive)
        if (const double q = quality(t); q < improved_below) poor.emplace_back(q, t);
    std::sort(poor.begin(), poor.end());
    for (const auto& [q, t] : poor) {
      if (!complex()[t].alive || quality(t) != q) continue;
      touched_.clear();
      if (improve_tet(t)) settle();
    }
  }

  void apply(Change change) {
    tets_ -= change.replacement.old.size();
    tets_ += change.replacement.created.size();
    const auto& changed = workpiece_.apply(std::move(change));
    touched_.insert(touched_.end(), changed.begin(), changed.end());
  }

  // What was changed stays.
  void settle() {
    ++clock_;
    for (const Index t : touched_) {
      if (!complex()[t].alive) continue;
      for (const Index v : complex()[t].corners) changed_[v] = clock_;
      queue_short_edges(t);
    }
    queue_found();
  }

  void store() {
    TetMesh& mesh = workpiece_.complex.mesh();
    if (report_.contracted_edges > 0) mesh.collar_balls.clear();  // their cells are not what they were
    workpiece_.complex.store();
    improvement::mark_thin_tets(mesh, radius_edge_);
    report_.tets_after = mesh.tets.size();
    report_.thin_tets = static_cast<std::size_t>(std::count(mesh.tet_thin.begin(), mesh.tet_thin.end(), 1));
  }

  Workpiece workpiece_;
  double radius_edge_;
  std::vector<double> sizes_;
  ThinShape thin_;
  CoarseningRule rule_;
  Operations operations_;
  const Execution& execution_;
  std::size_t tets_ = 0;
  std::priority_queue<Candidate> queue_;
  std::vector<Candidate> found_;
  std::unordered_map<std::uint64_t, std::uint32_t> tried_[2];  // when: without and with repair
  std::vector<std::uint32_t> changed_;                         // when: the tets at a vertex
  std::uint32_t clock_ = 0;
  std::vector<Index> touched_;
  std::vector<std::pair<Index, bool>> ends_;
  double shortest_ = 0, longest_ = 0;  // of the edges at the vertex asked about last
  CoarsenReport report_;
};

}  // namespace
}  // namespace coarsening

CoarsenReport coarsen(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with,
                      const CoarsenOptions& options, const Execution& execution) {
  if (!(options.thin_angle > 0 && options.thin_angle <= 30))
    throw OptionError("the smallest angle of thin tetrahedra must be above 0 and at most 30 degrees");
  return coarsening::Coarsening(mesh, plc, made_with, options, execution).run();
}

}  // namespace collarmesh
