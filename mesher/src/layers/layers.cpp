// Boundary layers: the front of the wall's triangles is pushed into the tets, and the space behind it is
// filled with cells.
#include <algorithm>
#include <map>
#include <utility>

#include "collarmesh/layers.h"
#include "common/stopwatch.h"
#include "common/thread_limit.h"
#include "layers/core.h"
#include "layers/curving.h"
#include "layers/front.h"
#include "layers/heights.h"
#include "layers/make.h"
#include "layers/stack.h"
#include "layers/wall_choice.h"
#include "remesh/cell_bounds.h"

namespace collarmesh {

namespace layering {
namespace {

// There are at most this many tries, besides those after folds (`most_refoldings`). Each lowers layers, or
// leaves them out, where the last one failed. After `last_levels` tries, layers are also left out in ever
// wider rings around these places.
constexpr unsigned most_tries = 9, last_levels = 4;
// If a node fails even at the level `Core::strictest`, its height is multiplied by this share in the next
// try. If it fails again, it gets no layers.
constexpr double further_share = 0.25;
// Number of times that layers are left out where curved cells fold, in ever wider rings. After that, edges of
// walls get straighter.
constexpr unsigned most_refoldings = 2;

class LayerMaker {
 public:
  LayerMaker(TetMesh& mesh, const Plc& plc, const LayerOptions& options, const ImproveOptions& improvement,
             const SecondOrderOptions& second_order, const Execution& execution)
      : mesh_(mesh),
        plc_(plc),
        options_(options),
        improvement_(improvement),
        second_order_(second_order),
        execution_(execution),
        walls_(options, plc),
        bulges_(mesh),
        is_second_order_(straightened(mesh)),
        complex_(mesh),
        front_(complex_, plc, walls_) {}

  /// Makes the layers. `second_order`: gets a report if the mesh has second order.
  LayersReport run(SecondOrderReport& second_order) {
    if (make() == Outcome::cancelled) report_.cancelled = true;
    second_order = std::move(made_second_order_);
    return report_;
  }

 private:
  enum class Outcome { taken, folded, cancelled };

  /// Removes the mid-edge nodes of a mesh. Returns whether it had any.
  static bool straightened(TetMesh& mesh) {
    if (mesh.order() == 1) return false;
    straighten(mesh);
    return true;
  }

  Outcome make() {
    Heights heights(front_, mesh_, plc_, walls_);
    heights.fit_gaps();
    heights.fit_patches(remeshing::SmoothSurfaces(plc_, mesh_, *improvement_.bounds.tolerance),
                        *improvement_.bounds.tolerance);
    heights.fit_bulges(bulges_);
    heights.settle();
    std::vector<std::uint8_t> levels(heights.size(), 0);
    for (unsigned attempt = 0, refoldings = 0; attempt < most_tries + refoldings; ++attempt) {
      Heights reached = heights;
      Core core(mesh_, plc_, front_, reached, improvement_, execution_);
      const bool done = core.push(reached, levels);
      if (core.cancelled()) return Outcome::cancelled;
      if (done) {
        const Outcome outcome = take(reached, core, refoldings == most_refoldings);
        if (outcome != Outcome::folded) return outcome;
        leave_out_folded(heights, (1U << refoldings++) - 1);
        continue;
      }
      if (attempt - refoldings >= last_levels) {
        const unsigned rings = (1U << (attempt - refoldings - last_levels)) - 1;
        for (const Index n : within_rings(front_.neighbours, core.failed(), rings))
          heights.lower(n, 0, Cause::core);
      }
      for (const Index n : core.failed()) {
        const std::uint8_t level = ++levels[n];
        if (level > Core::strictest + 1)
          heights.lower(n, 0, Cause::core);
        else if (level > Core::strictest)
          heights.lower(n, further_share * std::min(heights[n], reached[n]), Cause::core);
      }
      heights.settle();
    }
    for (Index n = 0; n < heights.size(); ++n) heights.lower(n, 0, Cause::core);
    return take(heights, Core(mesh_, plc_, front_, heights, improvement_, execution_), true);
  }

  /// Leaves layers out at nodes where curved cells fold, and within this many steps of them.
  void leave_out_folded(Heights& heights, unsigned rings) {
    std::vector<Index> nodes;
    for (Index n = 0; n < front_.nodes.size(); ++n)
      if (std::binary_search(folded_.begin(), folded_.end(), front_.nodes[n].vertex)) nodes.push_back(n);
    for (const Index n : within_rings(front_.neighbours, nodes, rings)) heights.lower(n, 0, Cause::fold);
    heights.settle();
  }

  /// Makes the mesh with layers of these heights. `at_last`: accepts folded cells, after straightening edges
  /// of walls.
  Outcome take(const Heights& heights, const Core& core, bool at_last) {
    Stack stack(mesh_, front_, heights, core, options_.tets);
    TetMesh made = stack.build();
    if (is_second_order_) {
      CurvedLayers curved = curve(made, plc_, bulges_, stack.places(), second_order_, execution_, at_last);
      if (curved.report.cancelled) return Outcome::cancelled;
      folded_ = std::move(curved.folded);
      std::sort(folded_.begin(), folded_.end());
      if (!folded_.empty() && !at_last) return Outcome::folded;
      made_second_order_ = std::move(curved.report);
    }
    describe(heights, made);
    report_.walls = stack.places().wall;
    mesh_ = std::move(made);
    return Outcome::taken;
  }

  double area_of(const WallSide& side) const {
    const auto& p = mesh_.points;
    const auto& [a, b, c] = side.corners;
    return 0.5 * norm(cross(p[b] - p[a], p[c] - p[a]));
  }

  void describe(const Heights& heights, const TetMesh& made) {
    report_.prisms = made.layers.prisms.size();
    report_.pyramids = made.layers.pyramids.size();
    report_.tets =
        static_cast<std::size_t>(std::count_if(made.layers.tet_layer.begin(), made.layers.tet_layer.end(),
                                               [](std::uint16_t layer) { return layer > 0; }));
    report_.largest_step = heights.largest_step();
    describe_patches(heights);
    describe_reductions(heights);
  }

  void describe_patches(const Heights& heights) {
    std::map<Tag, LayersReport::Patch> patches;
    constexpr std::size_t bins = std::tuple_size_v<decltype(LayersReport::Patch::histogram)>;
    for (const WallSide& side : front_.sides) {
      const Tag tag = mesh_.face_tag[side.face];
      LayersReport::Patch& patch = patches[tag];
      patch.tag = tag;
      const double area = area_of(side);
      double asked = 0, mean = 0;
      bool covered = true;
      for (const Index n : side.nodes) {
        asked += heights.asked_height(n) / 3;
        mean += std::min(heights.height(n), heights.asked_height(n)) / 3;
        covered = covered && heights[n] > 0;
      }
      patch.area += area;
      patch.asked += area * asked;
      patch.mean += area * mean;
      if (covered) patch.covered += area;
      const auto bin = static_cast<std::size_t>(static_cast<double>(bins) * mean / asked * (1 + 1e-6));
      patch.histogram[std::min(bins - 1, bin)] += area;
    }
    for (auto& [tag, patch] : patches) {
      const std::string* const name = mesh_.names.find(2, tag);
      patch.name = name != nullptr ? *name : "patch_" + std::to_string(tag);
      patch.asked /= patch.area;
      patch.mean /= patch.area;
      report_.patches.push_back(patch);
    }
  }

  void describe_reductions(const Heights& heights) {
    std::array<LayersReport::Reduction, static_cast<std::size_t>(Cause::count)> by_cause;
    for (Index n = 0; n < heights.size(); ++n) {
      if (heights.cause(n) == Cause::none || !heights.is_lower(n)) continue;
      LayersReport::Reduction& reduction = by_cause[static_cast<std::size_t>(heights.cause(n))];
      const double share = heights.height(n) / heights.asked_height(n);
      if (reduction.nodes++ > 0 && share >= reduction.smallest) continue;
      reduction.smallest = share;
      reduction.where = mesh_.points[front_.nodes[n].vertex];
    }
    for (std::size_t cause = 0; cause < by_cause.size(); ++cause) {
      if (by_cause[cause].nodes == 0) continue;
      by_cause[cause].why = text_of(static_cast<Cause>(cause));
      report_.reductions.push_back(by_cause[cause]);
    }
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const LayerOptions& options_;
  const ImproveOptions& improvement_;
  const SecondOrderOptions& second_order_;
  const Execution& execution_;
  WallChoice walls_;
  Bulges bulges_;
  bool is_second_order_;
  remeshing::TetComplex complex_;
  Front front_;
  std::vector<Index> folded_;  // vertices of walls at curved cells that folded, sorted
  LayersReport report_;
  SecondOrderReport made_second_order_;
};

}  // namespace

LayersReport make(TetMesh& mesh, const Plc& plc, const LayerOptions& options,
                  const ImproveOptions& improvement, const SecondOrderOptions& second_order,
                  const Execution& execution, SecondOrderReport& made) {
  const Stopwatch stopwatch;
  ImproveOptions with_tolerance = improvement;
  if (!with_tolerance.bounds.tolerance)
    with_tolerance.bounds.tolerance = tolerance_of_any_size(plc, improvement.bounds);
  LayersReport report;
  ThreadLimit(improvement.threads).run([&] {
    report = LayerMaker(mesh, plc, options, with_tolerance, second_order, execution).run(made);
    if (!report.cancelled && with_tolerance.bounds.thin_angle > 0)
      remeshing::mark_cells(mesh, plc, with_tolerance.bounds);
  });
  report.seconds = stopwatch.seconds();
  return report;
}

}  // namespace layering

double LayersReport::coverage() const {
  double all = 0, part = 0;
  for (const Patch& patch : patches) {
    all += patch.area;
    part += patch.covered;
  }
  return all > 0 ? part / all : 0;
}

LayersReport make_layers(TetMesh& mesh, const Plc& plc, const LayerOptions& options,
                         const ImproveOptions& improvement, const SecondOrderOptions& second_order,
                         const Execution& execution) {
  SecondOrderReport made;
  return layering::make(mesh, plc, options, improvement, second_order, execution, made);
}

}  // namespace collarmesh
