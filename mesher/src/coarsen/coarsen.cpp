#include "collarmesh/coarsen.h"

#include <algorithm>
#include <chrono>

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

// Edges below this times the target length are contracted.
constexpr double contracted_below = 0.8;
constexpr unsigned plain_passes = 4, repair_passes = 6, rounds = 3;
// A contraction that makes nothing worse than this may be repaired, in so many steps. Hardly a step mends two
// tets, so what has more tets to mend than steps left is given up.
constexpr double repairable = 0.15;
constexpr unsigned most_repairs = 16;
// Tets below this quality are improved between the passes.
constexpr double improved_below = 1.3;
constexpr unsigned most_sweeps = 8;
// A pass, or a round of them, that removes a smaller share of the tets is the last.
constexpr double least_share = 0.005;
constexpr std::size_t steps_between_reports = 4096;

class Coarsening {
 public:
  Coarsening(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with, const CoarsenOptions& options,
             const Execution& execution)
      : workpiece_(mesh, plc,
                   made_with.distance > 0 ? made_with.distance
                                          : default_distance(made_with.size, plc.bounds.diagonal()),
                   made_with.edges_per_hole),
        radius_edge_(made_with.radius_edge),
        sizes_(target_sizes(mesh, plc, sizes_asked_for(made_with))),
        thin_(plc, mesh, options.thin_angle, options.reserve),
        rule_(thin_, made_with.radius_edge, sizes_),
        operations_(workpiece_, rule_),
        execution_(execution),
        changed_(mesh.points.size(), 0),
        stamps_(mesh.points.size(), 0) {}

  // Holes stay round all the same.
  static MeshOptions sizes_asked_for(MeshOptions options) {
    options.edges_per_hole = 0;
    return options;
  }

  CoarsenReport run() {
    const auto started = std::chrono::steady_clock::now();
    report_.tets_before = tets_ = complex().size();
    workpiece_.prepare();
    for (unsigned pass = 0; pass < plain_passes && !report_.cancelled; ++pass)
      if (!contract_all(false)) break;
    // Improvement makes room for more contractions; between the passes of a round it would have all vertices
    // asked again.
    for (unsigned round = 0; round < rounds && !report_.cancelled; ++round) {
      improve_all();
      const std::size_t before = tets_;
      for (unsigned pass = 0; pass < repair_passes; ++pass)
        if (!contract_all(true)) break;
      if (!worthwhile(before)) break;
    }
    store();
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return report_;
  }

 private:
  struct Neighbour {
    double squared_relative_length;
    Index vertex;

    friend bool operator<(const Neighbour& x, const Neighbour& y) {
      return x.squared_relative_length != y.squared_relative_length
                 ? x.squared_relative_length < y.squared_relative_length
                 : x.vertex < y.vertex;
    }
  };

  const TetComplex& complex() const { return workpiece_.complex; }
  const TetMesh& mesh() const { return workpiece_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }

  double squared_relative_length(Index a, Index b) const {
    return rule_.squared_relative_length(squared_distance(mesh().points[a], mesh().points[b]), a, b);
  }
  static bool is_short(double squared_relative_length) {
    return squared_relative_length < contracted_below * contracted_below;
  }

  // The vertices with a short edge, those with the shortest one first, where something has changed since they
  // were asked last.
  std::vector<Neighbour> find_candidates(std::uint32_t changed_since) const {
    std::vector<double> shortest(mesh().points.size(), INFINITY);
    for (Index t = 0; t < complex().size(); ++t) {
      if (!complex()[t].alive) continue;
      const auto& v = complex()[t].corners;
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = i + 1; j < 4; ++j) {
          const double length = squared_relative_length(v[i], v[j]);
          shortest[v[i]] = std::min(shortest[v[i]], length);
          shortest[v[j]] = std::min(shortest[v[j]], length);
        }
    }
    std::vector<Neighbour> candidates;
    for (Index v = 0; v < shortest.size(); ++v)
      if (is_short(shortest[v]) && mesh().features[v].dimension > 0 && changed_[v] >= changed_since)
        candidates.push_back({shortest[v], v});
    std::sort(candidates.begin(), candidates.end());
    return candidates;
  }

  // Every vertex once. Is another pass worthwhile?
  bool contract_all(bool repair) {
    std::uint32_t& since = last_pass_[repair ? 1 : 0];
    const auto candidates = find_candidates(since);
    since = ++clock_;
    const std::size_t before = tets_;
    std::size_t steps = 0;
    for (const Neighbour& candidate : candidates) {
      if (stopped(++steps)) return false;
      if (complex().in_use(candidate.vertex)) contract_vertex(candidate.vertex, repair);
    }
    return worthwhile(before);
  }

  bool worthwhile(std::size_t before) const {
    return static_cast<double>(before - tets_) > least_share * static_cast<double>(before);
  }

  bool stopped(std::size_t step) {
    if (execution_.cancelled()) report_.cancelled = true;
    if (step % steps_between_reports == 0 && execution_.progress &&
        !execution_.progress({"coarsen", 0, 0, tets_}))
      report_.cancelled = true;
    return report_.cancelled;
  }

  // Onto the nearest neighbour that will do. Lengths rule out most neighbours, at less cost than the cone.
  void contract_vertex(Index vertex, bool repair) {
    find_neighbours(vertex);
    targets_.clear();
    for (const Neighbour& n : neighbours_) {
      if (!is_short(n.squared_relative_length)) break;
      if (lengths_fit(vertex, n.vertex)) targets_.push_back(n.vertex);
    }
    if (targets_.empty()) return;
    rule_.set_mode(Mode::final);
    if (!operations_.begin_contractions(vertex)) return;
    for (const Index onto : targets_)
      if (contract(onto)) return;
    if (!repair) return;
    const double floor = std::min(1.0, operations_.worst_at_vertex());
    for (const Index onto : targets_) {
      rule_.set_mode(Mode::force);
      if (!operations_.begin_contractions(vertex) || contract_and_repair(onto, floor)) return;
    }
  }

  // The nearest by the size first.
  void find_neighbours(Index vertex) {
    neighbours_.clear();
    ++stamp_;
    shortest_ = INFINITY;
    complex().star(vertex, star_);
    for (const Index t : star_)
      for (const Index w : complex()[t].corners) {
        if (w == vertex || stamps_[w] == stamp_) continue;
        stamps_[w] = stamp_;
        const double squared = squared_distance(mesh().points[vertex], mesh().points[w]);
        shortest_ = std::min(shortest_, squared);
        neighbours_.push_back({rule_.squared_relative_length(squared, vertex, w), w});
      }
    shortest_ = std::sqrt(shortest_);
    std::sort(neighbours_.begin(), neighbours_.end());
  }

  bool contract(Index onto) {
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
    ++stamp_;
    for (const Index t : star_) {
      const auto& v = complex()[t].corners;
      if (std::find(v.begin(), v.end(), onto) == v.end()) continue;
      for (const Index w : v) stamps_[w] = stamp_;
    }
    for (const Neighbour& n : neighbours_) {
      if (stamps_[n.vertex] == stamp_) continue;
      const double after = squared_distance(points[onto], points[n.vertex]);
      if (after < shortest_ * shortest_) return false;
      const double before = squared_distance(points[vertex], points[n.vertex]);
      if (!rule_.allows_edge(onto, n.vertex, after, before)) return false;
    }
    return true;
  }

  bool contract_and_repair(Index onto, double floor) {
    Change change;
    operations_.contract_onto(onto, repairable, -INFINITY, change);
    if (change.kind == Change::Kind::none) return false;
    workpiece_.begin_trial();
    touched_.clear();
    const std::size_t before = tets_;
    apply(std::move(change));
    rule_.set_mode(Mode::trial);
    for (unsigned step = 0;; ++step) {
      const auto [count, worst] = tets_to_mend(floor);
      if (count == 0) {
        workpiece_.keep();
        settle();
        ++report_.contracted_edges;
        ++report_.repaired;
        return true;
      }
      if (step + count > most_repairs + 1 || !improve_tet(worst)) break;
    }
    workpiece_.undo();
    tets_ = before;
    return false;
  }

  struct ToMend {
    std::size_t count = 0;
    Index worst = none;
  };
  // Of the tets that a trial made or changed those that must not stay.
  ToMend tets_to_mend(double floor) const {
    ToMend found;
    double least = INFINITY;
    for (const Index t : touched_) {
      if (!complex()[t].alive) continue;
      const double q = qualities_[t];
      if (q >= 1 || (q >= floor && rule_.keeps_guarantee(complex().corners(t), q))) continue;
      ++found.count;
      if (q >= least) continue;
      least = q;
      found.worst = t;
    }
    return found;
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

  // Until nothing more helps, so that asking again finds the mesh as it is.
  void improve_all() {
    rule_.set_mode(Mode::final);
    for (unsigned sweep = 0; sweep < most_sweeps && improve_once(); ++sweep) {
    }
  }

  bool improve_once() {
    std::vector<std::pair<double, Index>> poor;
    for (Index t = 0; t < complex().size(); ++t)
      if (complex()[t].alive && changed_since(t, last_sweep_))
        if (const double q = quality(t); q < improved_below) poor.emplace_back(q, t);
    std::sort(poor.begin(), poor.end());
    last_sweep_ = ++clock_;
    bool any = false;
    std::size_t steps = 0;
    for (const auto& [q, t] : poor) {
      if (stopped(++steps)) return false;
      if (!complex()[t].alive || quality(t) != q) continue;
      touched_.clear();
      if (!improve_tet(t)) continue;
      settle();
      any = true;
    }
    return any;
  }

  bool changed_since(Index tet, std::uint32_t when) const {
    const auto& v = complex()[tet].corners;
    return std::any_of(v.begin(), v.end(), [&](Index w) { return changed_[w] >= when; });
  }

  void apply(Change change) {
    tets_ -= change.replacement.old.size();
    tets_ += change.replacement.created.size();
    const auto& changed = workpiece_.apply(std::move(change));
    touched_.insert(touched_.end(), changed.begin(), changed.end());
    if (rule_.mode() == Mode::final) return;
    if (qualities_.size() < complex().size()) qualities_.resize(complex().size());
    rule_.set_mode(Mode::trial);
    for (const Index t : changed) qualities_[t] = quality(t);
  }

  // What was changed stays.
  void settle() {
    ++clock_;
    for (const Index t : touched_)
      if (complex()[t].alive)
        for (const Index v : complex()[t].corners) changed_[v] = clock_;
  }

  void store() {
    TetMesh& mesh = workpiece_.complex.mesh();
    mesh.collar_balls.clear();  // their cells are not what they were
    for (Index t = 0; t < complex().size(); ++t)
      if (complex()[t].alive && complex()[t].collar &&
          rule_.keeps_guarantee(complex().corners(t), quality(t)))
        workpiece_.complex.dissolve(t);
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
  std::vector<std::uint32_t> changed_;            // by vertex: when the tets at it did
  std::array<std::uint32_t, 2> last_pass_{0, 0};  // when it began, without and with repair
  std::uint32_t last_sweep_ = 0;                  // of improvement
  std::uint32_t clock_ = 0;
  std::vector<Index> touched_;
  std::vector<double> qualities_;      // by tet, of those a trial changed
  std::vector<Index> star_;            // tets at the vertex asked about last
  std::vector<Neighbour> neighbours_;  // of that vertex
  double shortest_ = 0;                // edge there
  std::vector<Index> targets_;         // neighbours that the length rules allow
  std::vector<std::uint32_t> stamps_;
  std::uint32_t stamp_ = 0;
  CoarsenReport report_;
};

}  // namespace
}  // namespace coarsening

CoarsenReport coarsen(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with,
                      const CoarsenOptions& options, const Execution& execution) {
  if (!(options.thin_angle > 0 && options.thin_angle <= 30))
    throw OptionError("the smallest angle of thin tetrahedra must be above 0 and at most 30 degrees");
  if (!(options.reserve >= 0 && options.reserve <= 0.5))
    throw OptionError("the reserve of angles must be from 0 to 0.5");
  return coarsening::Coarsening(mesh, plc, made_with, options, execution).run();
}

}  // namespace collarmesh
