#include "adapt/bring_to_size.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "adapt/edge_division.h"
#include "coarsen/coarsening_rule.h"
#include "coarsen/target_sizes.h"
#include "collarmesh/mesher.h"
#include "collarmesh/progress.h"
#include "common/cell_shapes.h"
#include "common/sort_uniquely.h"
#include "common/thread_limit.h"
#include "remesh/cell_bounds.h"
#include "remesh/editable_mesh.h"
#include "remesh/operations.h"

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

/// Brings a mesh with any shapes and lengths close to its sizes, so that coarsening and improvement, which
/// keep bounds, can do the rest.
/// No operation may reduce the quality of the worst tet around below a share of it, unless all new tets are
/// good. Collapses short edges first, shortest first, and improves tets in between; then divides long edges.
class Relaxation {
 public:
  /// Keeps the mesh and the execution by reference; `sizes` are targets at the vertices.
  Relaxation(EditableMesh& edited, const MeshOptions& options, const std::vector<double>& sizes,
             const Execution& execution)
      : edited_(edited),
        sizes_(sizes),
        bounds_{
            ThinShape(edited.plc, mesh(), options.bounds.thin_angle, options.bounds.reserve, edited.forced),
            CellBounds(edited.plc, mesh(), options.bounds)},
        rule_(bounds_, options.bounds.radius_edge, sizes_),
        operations_(edited, rule_),
        execution_(execution),
        changed_(mesh().points.size(), 0),
        kept_(mesh().points.size(), 0) {
    rule_.set_mode(coarsening::CoarseningRule::Mode::force);
    edited_.prepare();
  }

  /// Collapses short edges and improves tets, for lengths that grow up to the target.
  void contract() {
    for (const double length : lengths) {
      contract_short(length);
      improve_tets(good, Means::vertices);
      contract_again(length);
    }
  }

  /// Collapses edges shorter than this share of the target, without any improvement.
  void contract_short(double below) {
    kept_.assign(mesh().points.size(), 0);
    contract_again(below);
  }

  /// Improves tets and collapses edges where that has become possible.
  void improve() {
    improve_tets(better, Means::moves);
    contract_again(lengths.back());
    improve_tets(better, Means::vertices);
  }

  /// Returns the number of changes.
  std::size_t changes() const { return contractions_ + others_; }

 private:
  struct Near {
    double relative_length;
    Index vertex;
  };
  /// The means of improvement in addition to removing edges.
  enum class Means { edges, moves, vertices };
  static constexpr unsigned kinds_of_means = 3;

  const TetComplex& complex() const { return edited_.complex; }
  const TetMesh& mesh() const { return edited_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }
  double relative_length(Index a, Index b) const {
    return distance(mesh().points[a], mesh().points[b]) / (0.5 * (sizes_[a] + sizes_[b]));
  }

  /// Repeats collapses as long as that is worthwhile.
  void contract_again(double below) {
    for (unsigned pass = 0; pass < most_relaxations; ++pass)
      if (!contract_shorter_than(below)) break;
  }

  bool contract_shorter_than(double below) {
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

  bool contract_at(Index vertex, double below) {
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
  void find_neighbours(Index vertex, double below) {
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

  bool may_share_feature(Index vertex, Index onto) const {
    const auto &f = mesh().features[vertex], &g = mesh().features[onto];
    return f.dimension == 3 || g.dimension < f.dimension ||
           (g.dimension == f.dimension && g.feature == f.feature);
  }

  /// Improves tets as long as that is worthwhile, at first by removing edges alone.
  void improve_tets(double enough, Means later) {
    for (unsigned pass = 0; pass < most_improvements; ++pass)
      if (!improve_below(enough, pass == 0 ? Means::edges : later)) break;
  }

  bool improve_below(double enough, Means means) {
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
    return static_cast<double>(others_ - before) >
           least_share_changed * static_cast<double>(complex().size());
  }

  Change improvement_of(Index tet, double enough, Means means) {
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

  void apply(Change change) {
    ++now_;
    for (const Index t : edited_.apply(std::move(change)))
      for (const Index v : complex()[t].corners) changed_[v] = now_;
  }

  bool has_changed_since(Index tet, std::uint32_t when) const {
    const auto& v = complex()[tet].corners;
    return std::ranges::any_of(v, [&](Index w) { return changed_[w] >= when; });
  }

  /// Returns whether improving a tet with these or more means has failed since its corners last changed.
  bool was_tried(Index tet, Means means) const {
    for (auto kind = static_cast<unsigned>(means); kind < kinds_of_means; ++kind) {
      const auto& tried = not_better_[kind];
      if (tet < tried.size() && tried[tet] > 0 && !has_changed_since(tet, tried[tet])) return true;
    }
    return false;
  }

  bool stopped() {
    return execution_.cancelled() ||
           (++steps_ % steps_between_reports == 0 && execution_.progress &&
            !execution_.progress({"remesh", 0, mesh().points.size(), complex().size()}));
  }

  EditableMesh& edited_;
  std::vector<double> sizes_;  // by vertex
  TetBounds bounds_;
  coarsening::CoarseningRule rule_;
  Operations operations_;
  const Execution& execution_;
  std::vector<Index> star_, neighbours_;
  std::vector<Near> near_;  // neighbours of the last vertex, by length
  double longest_ = 0;      // longest edge there, relative to the target
  std::size_t contractions_ = 0, others_ = 0, steps_ = 0;
  // Times at which tets at a vertex last changed, and at which an attempt last failed. An attempt is repeated
  // only after a change.
  std::uint32_t now_ = 1;
  std::vector<std::uint32_t> changed_, kept_;                          // by vertex
  std::array<std::vector<std::uint32_t>, kinds_of_means> not_better_;  // by tet
};

// Number of rounds of divisions and improvement, and number of passes of divisions in each round.
constexpr unsigned rounds = 3, divisions = 2;
// A round that makes fewer changes than this share of the tets is the last one.
constexpr double least_share_of_round = 0.01;
// Largest number of passes that divide thin parts. Each halves the edges along them.
constexpr unsigned most_halvings = 12;
// Edges shorter than this share of the target lie around or across a thin part.
constexpr double around = 0.3;
// Edges longer than this factor times the target are divided.
constexpr double longest = coarsening::CoarseningRule::longest_new;

// Ratio of an edge to a short edge beside it; edges may grow from there by this much per unit of distance.
constexpr double of_shortest = 1.5, growth = 1;

// Graded sizes are used only if they multiply the number of tets by at most `most_times`, plus `some`.
constexpr double most_times = 2, some = 2000, tets_per_cube = 8;

class Bringing {
 public:
  Bringing(TetMesh& mesh, const Plc& plc, MeshOptions options, const Execution& execution)
      : mesh_(mesh), plc_(plc), options_(std::move(options)), execution_(execution) {
    options_.edges_per_hole = 0;  // a hole may have no edges but the existing ones
  }

  bool run() {
    relax([](Relaxation& relaxation) { relaxation.contract(); });
    if (is_thin()) divide_thin();
    for (unsigned round = 0; round < rounds && may_go_on(); ++round) {
      std::size_t changes = 0;
      for (unsigned pass = 0; pass < divisions && may_go_on(); ++pass) changes += divide();
      changes += relax([](Relaxation& relaxation) { relaxation.improve(); });
      if (static_cast<double>(changes) < least_share_of_round * static_cast<double>(mesh_.tets.size())) break;
    }
    if (may_go_on()) face_each_other();
    return may_go_on();
  }

  bool may_go_on() const {
    return !execution_.cancelled() &&
           (options_.max_vertices == 0 || mesh_.points.size() < options_.max_vertices);
  }

  /// Inserts vertices that face each other at tets that miss their bounds, and improves what remains, in
  /// rounds.
  void face_each_other() {
    for (unsigned round = 0; round < rounds && may_go_on() && divide_crossing() > 0; ++round)
      relax([](Relaxation& relaxation) { relaxation.improve(); });
  }

  std::size_t divide_crossing() {
    return edit([&](EditableMesh& edited) {
      return EdgeDivision(edited, options_, sizes()).divide_crossing(execution_);
    });
  }

  /// Returns the number of changes.
  template <class Stage>
  std::size_t relax(const Stage& stage) {
    return edit([&](EditableMesh& edited) {
      Relaxation relaxation(edited, options_, sizes(), execution_);
      stage(relaxation);
      return relaxation.changes();
    });
  }

 private:
  /// Stores the mesh that a stage has edited. Returns the number of changes, as the stage tells it.
  template <class Stage>
  std::size_t edit(const Stage& stage) {
    EditableMesh edited(mesh_, plc_, options_.bounds, options_.edges_per_hole);
    const std::size_t changes = stage(edited);
    edited.store();
    return changes;
  }

  std::vector<double> sizes() const { return coarsening::target_sizes(mesh_, plc_, options_); }

  /// Returns sizes that grow with the distance from edges shorter than the targets. Collapses have left these
  /// edges, so they will stay, and tets between short and long edges have poor shapes.
  std::vector<double> sizes_beside_short_edges() const {
    std::vector<double> graded = sizes();
    for (const auto& tet : mesh_.tets)
      for (const auto& [i, j] : cell_shapes::corner_pairs) {
        const double most = of_shortest * distance(mesh_.points[tet[i]], mesh_.points[tet[j]]);
        for (const Index v : {tet[i], tet[j]}) graded[v] = std::min(graded[v], most);
      }
    coarsening::grade_sizes(mesh_, growth, graded);
    return graded;
  }

  /// Returns whether sizes take far more tets than the targets, as graded ones do along thin parts.
  bool take_too_many_tets(const std::vector<double>& graded) const {
    return tets_of(graded) > most_times * tets_of(sizes()) + some;
  }

  /// Returns sizes beside short edges or, where they would take very many tets, the targets.
  std::vector<double> graded_sizes() const {
    std::vector<double> graded = sizes_beside_short_edges();
    return take_too_many_tets(graded) ? sizes() : graded;
  }

  bool is_thin() const { return take_too_many_tets(sizes_beside_short_edges()); }

  /// Divides edges along thin parts where vertices face each other, and collapses those around and across
  /// them that are no longer needed. Nothing moves in between, so that vertices go on facing each other.
  void divide_thin() {
    for (unsigned pass = 0; pass < most_halvings && may_go_on(); ++pass) {
      const std::size_t divided = edit([&](EditableMesh& edited) {
        EdgeDivision division(edited, options_, sizes());
        division.divide_facing();
        return division.divide_all(longest, options_.max_vertices, execution_);
      });
      if (divided == 0) break;
      relax([](Relaxation& relaxation) { relaxation.contract_short(around); });
    }
  }

  /// Estimates the number of tets for these sizes, given by vertex.
  double tets_of(const std::vector<double>& size) const {
    double sum = 0;
    for (const auto& tet : mesh_.tets) {
      const double mean = 0.25 * (size[tet[0]] + size[tet[1]] + size[tet[2]] + size[tet[3]]);
      double pieces = 1;  // number of pieces of the tet's extent
      for (const auto& [i, j] : cell_shapes::corner_pairs)
        pieces = std::max(pieces, distance(mesh_.points[tet[i]], mesh_.points[tet[j]]) / mean);
      const auto& p = mesh_.points;
      const double volume = six_volume(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]) / 6;
      sum += std::max(pieces, tets_per_cube * volume / (mean * mean * mean));
    }
    return sum;
  }

  /// Divides long edges. Returns how many.
  std::size_t divide() {
    return edit([&](EditableMesh& edited) {
      return EdgeDivision(edited, options_, graded_sizes())
          .divide_all(longest, options_.max_vertices, execution_);
    });
  }

  TetMesh& mesh_;
  const Plc& plc_;
  MeshOptions options_;
  const Execution& execution_;
};

}  // namespace

bool bring_to_size(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution) {
  bool ended = false;
  ThreadLimit(options.threads).run([&] { ended = Bringing(mesh, plc, options, execution).run(); });
  return ended;
}

void relax(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution) {
  ThreadLimit(options.threads).run([&] {
    Bringing bringing(mesh, plc, options, execution);
    bringing.relax([](Relaxation& relaxation) { relaxation.improve(); });
    bringing.face_each_other();
  });
}

bool face_each_other(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution) {
  bool changed = false;
  ThreadLimit(options.threads).run([&] {
    Bringing bringing(mesh, plc, options, execution);
    for (unsigned round = 0; round < rounds && bringing.divide_crossing() > 0; ++round) changed = true;
  });
  return changed;
}

}  // namespace collarmesh::remeshing::adapting
