#include "collarmesh/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include "collarmesh/error.h"

namespace collarmesh {

namespace {

using Clock = std::chrono::steady_clock;

// Where there is exact geometry the bounds have to hold still when the vertices have moved onto it: its
// triangles' share of the distance twice, and some room; of the ratio and the angles a little.
constexpr double distance_left = 0.75, ratio_left = 0.99, angle_reserve = 0.05;

/// A stage ended before its end; `PipelineResult::result` says why.
struct Ended {};

/// A flag that is set when another one is or when the time is up.
class Deadline {
 public:
  Deadline(double seconds, const Execution& execution)
      : watcher_([this, seconds, &execution](const std::stop_token& end) {
          using namespace std::chrono_literals;
          const Clock::time_point start = Clock::now();
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any ended;
          while (!ended.wait_for(lock, end, 10ms, [&end] { return end.stop_requested(); })) {
            if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) passed_ = true;
            if (passed_ || execution.cancelled()) flag_ = true;
          }
        }) {}

  bool passed() const { return passed_; }
  const std::atomic<bool>& flag() const { return flag_; }

 private:
  std::atomic<bool> flag_{false}, passed_{false};
  std::jthread watcher_;
};

class Pipeline {
 public:
  Pipeline(const PipelineOptions& options, const Execution& execution)
      : given_(options), options_(options), outer_(execution) {
    if (options.mesh.time_limit > 0) deadline_.emplace(options.mesh.time_limit, execution);
    inner_.cancel = deadline_ ? &deadline_->flag() : execution.cancel;
    if (execution.progress) inner_.progress = [this](const ProgressReport& report) { return go_on(report); };
  }

  SoupPipelineResult run(std::span<const PolygonSoup> soups) {
    SoupPipelineResult all;
    until_ended([&] { mesh_repaired(soups, all); });
    if (all.repair.repaired)
      made_.check.notes.push_back(fmt::format("the mesh was judged against the {} complex",
                                              all.repair.wrapped ? "wrapped" : "repaired"));
    static_cast<PipelineResult&>(all) = std::move(made_);
    return all;
  }

  PipelineResult run(const Plc& plc) {
    until_ended([&] { mesh(plc); });
    return std::move(made_);
  }

 private:
  void mesh_repaired(std::span<const PolygonSoup> soups, SoupPipelineResult& all) {
    build(soups, all);
    const std::optional<RepairOptions> next = next_repair(given_.repair, all.repair);
    if (!next) {
      mesh(all.plc);
      return;
    }
    options_ = before_next_repair(given_, *next, all.plc);
    bool has_mesh = false;
    try {
      mesh(all.plc);
      if (made_.guarantees_hold()) return;
      has_mesh = true;
    } catch (const Ended&) {
      if (inner_.cancelled() || !next->wrap_at_once) throw;
    } catch (const PlcError&) {
      // what comes next may do
    }
    options_ = given_;
    options_.repair = *next;
    PipelineResult missed = std::exchange(made_, {});
    SoupPipelineResult of_next;
    bool better = !has_mesh;
    try {
      build(soups, of_next);
      mesh(of_next.plc);
      better = better || made_.guarantees_hold();
    } catch (const PlcError&) {
      if (!has_mesh) throw;
    }
    if (better)
      all = std::move(of_next);
    else
      made_ = std::move(missed);
  }

  void build(std::span<const PolygonSoup> soups, SoupPipelineResult& all) {
    begin("complex", 0, 0.06);
    RepairedPlc built = build_repaired_plc(soups, options_.complex, options_.repair, inner_);
    all.repair = std::move(built.report);
    if (all.repair.cancelled) stop();
    all.plc = std::move(built.plc);
  }

  /// Refinement that does not end at one place with the samples of one seed may well end with those of
  /// another.
  void mesh(const Plc& plc) {
    const std::uint64_t first = options_.mesh.seed;
    go_all_stages(plc, first);
    for (std::uint64_t seed = first + 1; seed < first + options_.seeds && !made_.guarantees_hold(); ++seed) {
      PipelineResult missed = std::exchange(made_, {});
      bool holds = false;
      try {
        go_all_stages(plc, seed);
        holds = made_.guarantees_hold();
      } catch (const PlcError&) {
        // which is no better
      }
      if (holds)
        made_.check.notes.push_back(
            fmt::format("meshed again, with seed {}: with seed {}, {}", seed, first, missed.missed()));
      else
        made_ = std::move(missed);
    }
  }

  template <class Stages>
  void until_ended(const Stages& stages) {
    try {
      stages();
    } catch (const Ended&) {
      made_.result.mesh = {};
    }
  }

  void go_all_stages(const Plc& plc, std::uint64_t seed) {
    plc_ = &plc;
    require_known_tags(options_.mesh, plc);
    if (options_.order != 1 && options_.order != 2) throw OptionError("order must be 1 or 2");
    bounds_ = bounds_of_refinement();
    bounds_.seed = seed;
    refine();
    coarsen_elements();
    improve_elements();
    project();
    raise_order();
    certify();
  }

  double distance() const { return distance_of(options_, plc_->bounds.diagonal()); }
  bool exact() const { return static_cast<bool>(options_.exact); }
  /// Of the bounds on angles, where vertices move onto exact geometry afterwards.
  double reserve() const { return exact() ? angle_reserve : 0; }

  MeshOptions bounds_of_refinement() const {
    MeshOptions bounds = options_.mesh;
    bounds.distance = distance();
    bounds.time_limit = 0;  // one limit for all stages
    if (!exact()) return bounds;
    bounds.distance *= distance_left;
    bounds.radius_edge = std::max(1.0, ratio_left * bounds.radius_edge);
    return bounds;
  }

  void refine() {
    begin("refine", 0.06, options_.coarsen ? 0.6 : 0.7);
    MeshResult& result = made_.result = generate(*plc_, bounds_, inner_);
    if (result.status == MeshStatus::cancelled && out_of_time()) stop();
    if (result.status == MeshStatus::cancelled || result.status == MeshStatus::budget_hit) throw Ended();
  }

  void coarsen_elements() {
    if (!options_.coarsen || made_.result.status != MeshStatus::complete) return;
    begin("coarsen", 0.6, 0.7);
    made_.coarsening = coarsen(made_.result.mesh, *plc_, bounds_,
                               {.thin_angle = options_.thin_angle, .reserve = reserve()}, inner_);
    if (made_.coarsening->cancelled) stop();
  }

  void improve_elements() {
    if (options_.improve == 0 || made_.result.status != MeshStatus::complete) return;
    begin("improve", 0.7, 0.8);
    ImproveOptions options = improve_options(options_.improve);
    options.radius_edge = bounds_.radius_edge;
    options.distance = bounds_.distance;
    options.threads = options_.threads;
    if (made_.coarsening) {
      options.thin_angle = options_.thin_angle;
      options.thin_reserve = reserve();
      options.keep_vertices = true;
    }
    if (options_.min_dihedral > 0) options.min_dihedral = options_.min_dihedral;
    made_.improvement = improve(made_.result.mesh, *plc_, options, inner_);
    if (made_.improvement.cancelled) stop();
  }

  void project() {
    if (!exact() || made_.result.status != MeshStatus::complete) return;
    begin("project", 0.8, 0.83);
    ProjectOptions options;
    options.radius_edge = options_.mesh.radius_edge;
    options.collar_angle = options_.mesh.collar_angle;
    options.reach = distance();
    if (made_.coarsening) options.thin_angle = options_.thin_angle;
    made_.projection = project_boundary(made_.result.mesh, *plc_, options_.exact, options, inner_);
  }

  void raise_order() {
    if (options_.order == 1) return;
    begin("second order", 0.83, 0.86);
    made_.second_order = make_second_order(made_.result.mesh, *plc_, {.exact = options_.exact}, inner_);
    if (made_.second_order.cancelled) stop();
  }

  void certify() {
    begin("check", 0.86, 1);
    CheckOptions options;
    options.radius_edge = options_.mesh.radius_edge;
    options.distance = distance();
    options.thin_angle = options_.thin_angle;
    options.collar_angle = options_.mesh.collar_angle;
    options.crease_angle = options_.mesh.crease_angle;
    options.threads = options_.threads;
    made_.check = check(made_.result.mesh, *plc_, options, inner_);
    stop_if_asked();
  }

  void begin(std::string_view stage, double from, double to) {
    stage_ = stage;
    from_ = from;
    to_ = to;
    stop_if_asked();
    if (outer_.progress && !go_on({.phase = stage,
                                   .fraction = 0,
                                   .vertices = made_.result.mesh.points.size(),
                                   .tets = made_.result.mesh.tets.size(),
                                   .begins = true}))
      stop();
  }

  void stop_if_asked() {
    if (inner_.cancelled()) stop();
  }

  /// What a stage reports, as a part of the whole.
  bool go_on(ProgressReport report) {
    fraction_ = std::max(fraction_, from_ + std::clamp(report.fraction, 0.0, 1.0) * (to_ - from_));
    report.fraction = fraction_;
    return outer_.progress(report);
  }

  [[noreturn]] void stop() {
    MeshResult& result = made_.result;
    result.status = out_of_time() ? MeshStatus::budget_hit : MeshStatus::cancelled;
    result.message =
        out_of_time()
            ? fmt::format("the time limit of {} s is reached ({}); raise it, or size for a coarser mesh",
                          options_.mesh.time_limit, stage_)
            : fmt::format("the run was stopped ({})", stage_);
    throw Ended();
  }

  bool out_of_time() const { return deadline_ && deadline_->passed(); }

  const PipelineOptions& given_;
  PipelineOptions options_;  // of the attempt
  const Execution& outer_;
  Execution inner_;
  std::optional<Deadline> deadline_;
  MeshOptions bounds_;
  const Plc* plc_ = nullptr;
  PipelineResult made_;
  std::string_view stage_;
  double from_ = 0, to_ = 0, fraction_ = 0;  // of the stage in the whole
};

}  // namespace

PipelineOptions before_next_repair(PipelineOptions options, const RepairOptions& next, const Plc& plc) {
  constexpr double always = 3e5, per_cube_of_size = 20, sizes_per_diagonal = 20;
  options.seeds = 1;
  const MeshOptions& m = options.mesh;
  const bool one_size =
      !m.size_field && m.region_size.empty() && m.patch_size.empty() && m.curve_size.empty();
  if (!next.wrap_at_once || !one_size) return options;
  const double size = m.size > 0 ? m.size : plc.bounds.diagonal() / sizes_per_diagonal;
  double vertices = always;
  for (const Plc::Region& region : plc.regions)
    vertices += per_cube_of_size * region.volume / std::pow(region.size > 0 ? region.size : size, 3);
  if (vertices < 1e9 && (m.max_vertices == 0 || vertices < static_cast<double>(m.max_vertices)))
    options.mesh.max_vertices = static_cast<std::size_t>(vertices);
  return options;
}

std::string PipelineResult::missed() const {
  if (!result.message.empty() || check.findings.empty()) return result.message;
  return check.findings.front().message;
}

double distance_of(const PipelineOptions& options, double diagonal) {
  return options.mesh.distance > 0
             ? options.mesh.distance
             : default_distance(options.mesh.size, diagonal, static_cast<int>(options.order));
}

SoupPipelineResult run_pipeline(std::span<const PolygonSoup> soups, const PipelineOptions& options,
                                const Execution& execution) {
  return Pipeline(options, execution).run(soups);
}

PipelineResult run_pipeline(const Plc& plc, const PipelineOptions& options, const Execution& execution) {
  return Pipeline(options, execution).run(plc);
}

}  // namespace collarmesh
