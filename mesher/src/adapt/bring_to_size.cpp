#include "adapt/bring_to_size.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "adapt/edge_division.h"
#include "adapt/relaxation.h"
#include "coarsen/target_sizes.h"
#include "common/cell_shapes.h"
#include "common/thread_limit.h"
#include "remesh/editable_mesh.h"
#include "remesh/metric.h"

namespace collarmesh::remeshing::adapting {

namespace {

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
// If more than the share `most_of_long` of the tets has an edge longer than `far_too_long` times the target
// when no edge can be divided any more, edges that long are divided whatever the shapes of the new tets.
constexpr double far_too_long = 2.5, most_of_long = 0.01;
// `longest` is reduced by this share times (seed modulo `different_seeds`), so that different seeds make
// different meshes.
constexpr double less_by_seed = 0.03;

// An edge beside a short edge may be `of_shortest` times as long as the short one; from there edges may grow
// by `growth` per unit of distance.
constexpr double of_shortest = 1.5, growth = 1;

// Graded sizes are used only if they take at most `most_times` as many tets as the targets, plus `some`. The
// estimate counts `tets_per_cube` tets in a cube whose side is the target.
constexpr double most_times = 2, some = 2000, tets_per_cube = 8;

class Bringing {
 public:
  Bringing(TetMesh& mesh, const Plc& plc, MeshOptions options, const Execution& execution)
      : mesh_(mesh), plc_(plc), options_(std::move(options)), execution_(execution) {
    options_.edges_per_hole = 0;  // asks for no further edges around holes
    longest_ = longest * (1 - less_by_seed * static_cast<double>(options_.seed % different_seeds));
  }

  bool run() {
    relax([](Relaxation& relaxation) { relaxation.collapse(); });
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

  /// Divides edges of tets that miss their bounds, so that the new vertices face each other, and improves
  /// tets; in several rounds.
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
  /// Runs a stage on an editable copy of the mesh and stores the result. Returns the number of changes.
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

  /// Returns sizes beside short edges or, if they would take far too many tets, the targets.
  std::vector<double> graded_sizes() const {
    std::vector<double> graded = sizes_beside_short_edges();
    return take_too_many_tets(graded) ? sizes() : graded;
  }

  bool is_thin() const { return take_too_many_tets(sizes_beside_short_edges()); }

  /// Divides edges along thin parts at places that face vertices, and collapses edges around and across these
  /// parts that are no longer needed. Nothing moves in between, so that vertices go on facing each other.
  void divide_thin() {
    bool any_shape = false;
    for (unsigned pass = 0; pass < most_halvings && may_go_on(); ++pass) {
      const std::size_t divided = edit([&](EditableMesh& edited) {
        EdgeDivision division(edited, options_, sizes());
        division.divide_facing();
        if (any_shape) division.accept_any_shape();
        return division.divide_all(any_shape ? far_too_long : longest_, options_.max_vertices, execution_);
      });
      if (divided > 0) relax([](Relaxation& relaxation) { relaxation.collapse_short(around); });
      // If only the corners of a thin wall face each other, dividing the first of its edges makes a poor tet.
      if (divided == 0 && (any_shape || !are_far_too_long())) break;
      any_shape = divided == 0;
    }
  }

  /// Returns whether many tets have edges far longer than their targets.
  bool are_far_too_long() const {
    const Metric metric(sizes());
    const auto& p = mesh_.points;
    const auto is_long = [&](const std::array<Index, 4>& tet) {
      return std::ranges::any_of(cell_shapes::corner_pairs, [&](const auto& edge) {
        return metric.length(tet, p[tet[edge[1]]] - p[tet[edge[0]]]) > far_too_long;
      });
    };
    return most_of_long * static_cast<double>(mesh_.tets.size()) <
           static_cast<double>(std::ranges::count_if(mesh_.tets, is_long));
  }

  /// Estimates the number of tets for these sizes, given by vertex.
  double tets_of(std::vector<double> sizes) const {
    const Metric metric(std::move(sizes));
    const auto& p = mesh_.points;
    double sum = 0;
    for (const auto& tet : mesh_.tets) {
      double pieces = 1;  // length of the longest edge in target lengths, at least 1
      for (const auto& [i, j] : cell_shapes::corner_pairs)
        pieces = std::max(pieces, metric.length(tet, p[tet[j]] - p[tet[i]]));
      const double volume = six_volume(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]) / 6;
      sum += std::max(pieces, tets_per_cube * metric.volume(tet, volume));
    }
    return sum;
  }

  /// Divides long edges. Returns how many.
  std::size_t divide() {
    return edit([&](EditableMesh& edited) {
      return EdgeDivision(edited, options_, graded_sizes())
          .divide_all(longest_, options_.max_vertices, execution_);
    });
  }

  TetMesh& mesh_;
  const Plc& plc_;
  MeshOptions options_;
  const Execution& execution_;
  double longest_;
};

}  // namespace

bool bring_to_size(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution) {
  assert(options.bounds.tolerance);
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
