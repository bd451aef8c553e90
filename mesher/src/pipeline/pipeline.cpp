#include "collarmesh/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "check/guarantees.h"
#include "check/periodic.h"
#include "check/split.h"
#include "coarsen/coarsen_workpiece.h"
#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "collarmesh/partition.h"
#include "collarmesh/usable_threads.h"
#include "common/thread_limit.h"
#include "common/traced_mesh.h"
#include "constrained/constrained_tetrahedra.h"
#include "improve/cell_bounds.h"
#include "improve/divide_curves.h"
#include "improve/improve_workpiece.h"
#include "improve/interior_nodes.h"
#include "periodic/change_across.h"
#include "periodic/make_periodic.h"
#include "periodic/node_map.h"
#include "periodic/tolerance_across.h"
#include "pipeline/explosion.h"
#include "pipeline/lost_parts.h"
#include "pipeline/vertex_bound.h"
#include "predict/vertex_counts.h"
#include "refine/generate_linked.h"
#include "remesh/bring_to_size.h"
#include "shells/run.h"

namespace collarmesh {

namespace {

using Clock = std::chrono::steady_clock;

// With exact geometry the bounds must still hold after the vertices moved onto it. So these reserves are
// kept: twice the triangles' share of the distance and some more, and a little of the ratio and the angles.
constexpr double distance_left = 0.75, ratio_left = 0.99, angle_reserve = 0.05, dihedral_reserve = 0.02;

// Refinement ended with this bound in collars on all shapes tried. Coarsening and improvement reach less.
constexpr double reached_collar_angle = 130;

/// Thrown if a stage stops early; `PipelineResult::result` says why.
struct Ended {};

/// Thrown where constrained tetrahedra keep poor shapes and other ways are left.
struct Hopeless {};
enum class Hope { any, good };

bool is_about_shape(const Finding& f) {
  return f.guarantee == guarantee::thin_angles || f.guarantee == guarantee::collar_dihedral ||
         f.guarantee == guarantee::radius_edge;
}

/// A flag that is set if another one is set or the time is up.
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

/// Determines the number of usable threads in the background while refinement runs.
class ThreadCounter {
 public:
  explicit ThreadCounter(unsigned threads) {
    if (threads == 1) return;
    try {
      thread_ = std::jthread([] { usable_threads(); });
    } catch (const std::system_error&) {
      // The first user of threads determines it then.
    }
  }

 private:
  std::jthread thread_;
};

/// A source of complexes built from facets.
class SoupSource : public ComplexSource {
 public:
  /// Keeps both by reference.
  SoupSource(std::span<const PolygonSoup> soups, const PlcOptions& options)
      : soups_(soups), options_(options) {}

  RepairedPlc build(const RepairOptions& repair, const Execution& execution) override {
    return build_repaired_plc(soups_, options_, repair, execution);
  }
  void adapt(const Plc&, PipelineOptions&) override {}

 private:
  std::span<const PolygonSoup> soups_;
  const PlcOptions& options_;
};

class Pipeline {
 public:
  Pipeline(const PipelineOptions& options, const Execution& execution)
      : given_(with_profile(options)),
        start_(given_.start),
        outer_(execution),
        counter_(options.mesh.threads) {
    validate({options});
    if (options.partitions > 0) require_partitioner();
    if (options.mesh.time_limit > 0) deadline_.emplace(options.mesh.time_limit, execution);
    inner_.cancel = deadline_ ? &deadline_->flag() : execution.cancel;
    if (execution.progress) inner_.progress = [this](const ProgressReport& report) { return go_on(report); };
  }

  SoupPipelineResult run(ComplexSource& source) {
    if (given_.dimension < 3) {
      to_ = 1;
      return told_of_time(shells::run(source, given_, inner_));
    }
    source_ = &source;
    SoupPipelineResult all;
    until_ended([&] {
      try_repairs(all);
      divide();
      split_patches();
    });
    if (all.repair.repaired)
      made_.check.notes.push_back(fmt::format("the mesh was judged against the {} complex",
                                              all.repair.wrapped ? "wrapped" : "repaired"));
    static_cast<PipelineResult&>(all) = std::move(made_);
    return all;
  }

  PipelineResult run(const Plc& plc) {
    if (given_.dimension < 3) {
      to_ = 1;
      return told_of_time(shells::run(plc, given_, inner_));
    }
    until_ended([&] {
      bound_vertices(Ways::none);
      mesh_refined_or_constrained(plc);
      try_seeds(plc);
      divide();
      split_patches();
    });
    return std::move(made_);
  }

 private:
  /// The outcome of an attempt at a mesh.
  enum class End {
    holds,     ///< every guarantee
    missed,    ///< a guarantee
    exploded,  ///< it took more vertices than its sizes ask for
    refused    ///< no collar fits between features
  };

  /// Whether anything else is tried where a refinement explodes.
  enum class Ways { others, none };

  void try_repairs(SoupPipelineResult& all) {
    build(given_.repair, all);
    if (start_ == Start::constrained) {
      bound_vertices(Ways::none);
      return mesh(all.plc, given_.mesh.seed);
    }
    bound_vertices(Ways::others);
    std::exception_ptr error;
    const auto tried = attempt(all.plc, error);
    const End end = tried.first;
    const std::string& why = tried.second;
    if (end == End::holds) return;
    RepairOptions current = given_.repair;
    bool has_mesh = end == End::missed, built_last = true;
    for (const RepairOptions& repair : repairs_after(end, all)) {
      SoupPipelineResult other;
      const bool better = find_better(has_mesh, [&] {
        build(repair, other);
        if (repair.wrap_at_once) bound_vertices(Ways::none);
        if (end == End::exploded && !repair.wrap_at_once) require_kept(all, other);
        mesh(other.plc, given_.mesh.seed);
      });
      built_last = better;
      if (!better) continue;
      current = repair;
      all.plc = std::move(other.plc);
      all.repair = std::move(other.repair);
      has_mesh = true;
      made_.check.notes.push_back(all.repair.wrapped
                                      ? fmt::format("wrapped, as of the complex before {}", why)
                                      : fmt::format("repaired with a tolerance of {:.3g}, as with {:.3g} {}",
                                                    repair.tolerance, given_.repair.tolerance, why));
      if (made_.guarantees_hold() || end == End::exploded) break;
    }
    if (has_mesh && made_.guarantees_hold()) return;
    if (!built_last) {
      try {
        build(current, all);  // its source is to know it again
      } catch (const PlcError&) {
        if (!has_mesh) throw;
        return;
      }
    }
    if (!has_mesh) {
      bound_vertices(Ways::none);
      if (error) {
        std::optional<PipelineResult> constrained = from_constrained(all.plc, why, Hope::any);
        if (!constrained) std::rethrow_exception(error);
        made_ = std::move(*constrained);
        return;
      }
      mesh_anyhow(all.plc, why);
    }
    try_seeds(all.plc);
  }

  /// Meshes a complex; where the refinement takes far too many vertices, from its constrained tetrahedra.
  void mesh_refined_or_constrained(const Plc& plc) {
    try {
      return mesh(plc, given_.mesh.seed);
    } catch (const Ended&) {
      if (!hit_bound()) throw;
      std::optional<PipelineResult> constrained =
          from_constrained(plc, describe_explosion(plc, most_vertices_, made_.result.where), Hope::any);
      if (!constrained) throw;
      is_constrained_ = true;
      made_ = std::move(*constrained);
    }
  }

  /// Meshes a complex where no other way is left: from its constrained tetrahedra if that keeps every
  /// guarantee; else refined as far as the budgets allow; else from these tetrahedra all the same.
  void mesh_anyhow(const Plc& plc, const std::string& why) {
    if (take_constrained(plc, why)) return;
    try {
      return mesh(plc, given_.mesh.seed);
    } catch (const Ended&) {
      if (!hit_bound()) throw;
      std::optional<PipelineResult> constrained = from_constrained(plc, why, Hope::any);
      if (!constrained) throw;
      is_constrained_ = true;
      made_ = std::move(*constrained);
    }
  }

  /// Takes the mesh from the constrained tetrahedra if it keeps every guarantee.
  bool take_constrained(const Plc& plc, const std::string& why) {
    constexpr std::size_t most_triangles = 12'000;  // else it takes longer than other ways
    if (plc.triangles.size() > most_triangles || hopeless_ == &plc) return false;
    std::optional<PipelineResult> constrained = from_constrained(plc, why, Hope::good);
    is_constrained_ = constrained && constrained->guarantees_hold();
    hopeless_ = is_constrained_ ? nullptr : &plc;
    if (is_constrained_) made_ = std::move(*constrained);
    return is_constrained_;
  }

  /// Meshes a complex from its constrained tetrahedra; nothing where there are none, where others are asked
  /// for, where the mesh misses more than bounds on shapes, or, with good hope only, where many tets miss
  /// these.
  std::optional<PipelineResult> from_constrained(const Plc& plc, const std::string& why, Hope hope) {
    if (given_.start != Start::automatic || !given_.coarsen || given_.periodic.any()) return {};
    PipelineResult before = std::exchange(made_, {});
    std::optional<PipelineResult> found;
    start_ = Start::constrained;
    hope_ = hope;
    const std::unique_ptr<Pipeline, void (*)(Pipeline*)> restore(this, [](Pipeline* pipeline) {
      pipeline->start_ = Start::automatic;
      pipeline->hope_ = Hope::any;
    });
    try {
      mesh(plc, given_.mesh.seed);
      made_.check.notes.push_back(fmt::format("begun with constrained tetrahedra, as {}", why));
      if (std::ranges::all_of(made_.check.findings, is_about_shape)) found = std::move(made_);
    } catch (const Hopeless&) {
      found.reset();
    } catch (const PlcError&) {
      found.reset();
    } catch (const Ended&) {
      if (!hit_bound()) throw;
    }
    made_ = std::move(before);
    return found;
  }

  /// Meshes a complex within the bound on vertices. Also returns the reason for a missed guarantee.
  std::pair<End, std::string> attempt(const Plc& plc, std::exception_ptr& error) {
    try {
      mesh(plc, given_.mesh.seed);
      return {made_.guarantees_hold() ? End::holds : End::missed, made_.missed()};
    } catch (const Ended&) {
      if (!hit_bound()) throw;
      return {End::exploded, describe_explosion(plc, most_vertices_, made_.result.where)};
    } catch (const PlcError& e) {
      error = std::current_exception();
      return {End::refused, e.what()};
    }
  }

  std::vector<RepairOptions> repairs_after(End end, const SoupPipelineResult& all) const {
    if (end == End::missed && misses_collar_angle_only()) return {};
    std::vector<RepairOptions> repairs = further_repairs(given_.repair, all.repair);
    if (end != End::exploded) return repairs;
    std::erase_if(repairs, [](const RepairOptions& repair) { return !repair.wrap_at_once; });
    const double diagonal = all.plc.bounds.diagonal();
    std::vector<RepairOptions> coarser =
        coarser_repairs(given_.repair, smallest_size(given_.mesh, diagonal), diagonal);
    repairs.insert(repairs.begin(), coarser.begin(), coarser.end());
    return repairs;
  }

  /// The angles in collars are those of creases, which repair leaves as they are.
  bool misses_collar_angle_only() const {
    return made_.result.status == MeshStatus::complete &&
           std::ranges::all_of(made_.check.findings, [](const Finding& finding) {
             return finding.guarantee == guarantee::collar_dihedral;
           });
  }

  /// Throws PlcError unless a coarser repair changes something and loses no part.
  static void require_kept(const SoupPipelineResult& finer, const SoupPipelineResult& coarser) {
    const bool same =
        finer.plc.triangles.size() == coarser.plc.triangles.size() && finer.plc.points == coarser.plc.points;
    const std::string lost =
        same ? "nothing would change" : lost_parts(finer.plc, finer.repair, coarser.plc, coarser.repair);
    if (!lost.empty()) throw PlcError(lost, {});
  }

  /// Refinement that does not end at one place with the samples of one seed may well end with those of
  /// another. Where regions do not keep their volumes the surface distance shrinks, too.
  void try_seeds(const Plc& plc) {
    if (is_constrained_ || start_ == Start::constrained) return;  // no seed changes it
    const std::uint64_t first = given_.mesh.seed;
    for (std::uint64_t seed = first + 1; seed < first + given_.seeds && !made_.guarantees_hold(); ++seed) {
      const std::string missed = made_.missed();
      if (const double share = share_for_volumes(); share < 1) nearer_ = tolerance(plc, 1).scaled(share);
      if (find_better(true, [&] { mesh(plc, seed); }))
        made_.check.notes.push_back(fmt::format("made with seed {}, as with {} {}", seed, first, missed));
    }
    try_narrow_places_otherwise(plc);
  }

  /// Cells that were left in narrow places may keep large angles. Then the ratio is bounded there, too, if
  /// that takes not many times the vertices. Where it was bounded, they are left.
  void try_narrow_places_otherwise(const Plc& plc) {
    constexpr std::size_t times = 10, more = 100'000;
    if (!given_.coarsen || !missed(guarantee::thin_angles)) return;
    const std::string missed = made_.missed();
    const bool were_left = made_.result.has_narrow_cells;
    const std::size_t before = most_vertices_;
    if (were_left) {
      most_vertices_ = times * made_.result.statistics.vertices_inserted + more;
      for (const std::size_t bound : {before, given_.mesh.max_vertices})
        if (bound > 0) most_vertices_ = std::min(most_vertices_, bound);
    }
    narrow_cells_ = were_left ? NarrowCells::bounded : NarrowCells::left;
    if (find_better(true, [&] { mesh(plc, given_.mesh.seed); }))
      made_.check.notes.push_back(fmt::format("made with {} narrow places, as otherwise {}",
                                              were_left ? "a bounded ratio in" : "any ratio in", missed));
    most_vertices_ = before;
    narrow_cells_ = NarrowCells::bounded_if_cheap;
  }

  bool missed(const char* guarantee) const {
    return std::ranges::any_of(made_.check.findings,
                               [&](const Finding& finding) { return finding.guarantee == guarantee; });
  }

  /// Returns the share of the surface distance of first order with which regions keep their volumes and thin
  /// places their thickness: the loss is about proportional to the distance.
  double share_for_volumes() const {
    constexpr double aim = 0.7, least = 0.25;
    const double allowed = volume_allowance(static_cast<int>(given_.order));
    double share = 1;
    if (given_.mesh.bounds.distance > 0 || given_.mesh.bounds.tolerance) return share;  // as asked for
    const ShapeMeasures &input = made_.check.of_input, &mesh = made_.check.of_mesh;
    const auto keep = [&](double given, double made) {
      if (const double off = std::fabs(made - given); off > allowed * given)
        share = std::min(share, std::max(least, aim * allowed * given / off));
    };
    for (std::size_t r = 1; r < std::min(input.volumes.size(), mesh.volumes.size()); ++r)
      keep(input.volumes[r], mesh.volumes[r]);
    for (std::size_t i = 0; i < std::min(input.shells.size(), mesh.shells.size()); ++i)
      keep(input.shells[i], mesh.shells[i]);
    if (missed(guarantee::thickness_kept)) share = least;
    return share;
  }

  /// Tries another way. The present result stays unless it is no mesh or the other one keeps every
  /// guarantee.
  template <class Way>
  bool find_better(bool has_mesh, const Way& way) {
    PipelineResult kept = std::exchange(made_, {});
    bool better = false;
    const auto fails = [&] {
      if ((!has_mesh && !hit_bound()) || made_.result.status == MeshStatus::cancelled) throw;
    };
    try {
      way();
      better = !has_mesh || made_.guarantees_hold();
    } catch (const PlcError&) {
      better = false;
    } catch (const OptionError&) {  // the tags of sizes may be gone
      better = false;
    } catch (const Ended&) {
      fails();
    } catch (const std::bad_alloc&) {
      fails();
    }
    if (!better) made_ = std::move(kept);
    return better;
  }

  void build(const RepairOptions& repair, SoupPipelineResult& all) {
    begin("complex", 0, 0.06);
    RepairedPlc built = source_->build(repair, inner_);
    all.repair = std::move(built.report);
    if (all.repair.cancelled) stop();
    all.plc = std::move(built.plc);
    tolerance_.reset();
    nearer_.reset();
    hopeless_ = nullptr;
  }

  const SurfaceTolerance& tolerance(const Plc& plc) {
    if (!tolerance_) tolerance_ = tolerance(plc, static_cast<int>(given_.order));
    return *tolerance_;
  }

  SurfaceTolerance tolerance(const Plc& plc, int order) const {
    std::optional<SurfaceTolerance> found;
    ThreadLimit(given_.mesh.threads).run([&] {
      found = tolerance_of(plc, given_.mesh.bounds, given_.mesh.size, order);
    });
    return *found;
  }

  /// The next refinement, and those after it, end beyond far more vertices than the sizes ask for: soon while
  /// there are other ways, later where there are none.
  void bound_vertices(Ways ways) {
    ways_ = given_.repair.mode == RepairMode::off || given_.repair.wrap_at_once ? Ways::none : ways;
    knows_bound_ = false;
  }

  /// Finds that bound. A budget that was given takes the place of the last one, and of any that is larger.
  void find_bound() {
    // Bodies far thinner than the size take many vertices rightly; so many take ten seconds.
    constexpr std::size_t times_without_other_ways = 2, least_without_other_ways = 300'000;
    const std::size_t given = given_.mesh.max_vertices;
    knows_bound_ = true;
    most_vertices_ = 0;
    if (given_.mesh.profile == Profile::paper) return;  // it has no sizes to expect vertices of
    if (ways_ == Ways::none && given > 0) return;
    std::size_t most = most_vertices_expected(*plc_, options_);
    if (ways_ == Ways::none) most = std::max(times_without_other_ways * most, least_without_other_ways);
    if (given == 0 || given > most) most_vertices_ = most;
  }

  /// Returns whether the refinement ended at that bound, and not for lack of time or memory.
  bool hit_bound() const {
    const std::size_t memory = given_.mesh.max_memory;
    return most_vertices_ > 0 && made_.result.status == MeshStatus::budget_hit && !out_of_time() &&
           (memory == 0 || made_.result.statistics.peak_bytes <= memory);
  }

  template <class Stages>
  void until_ended(const Stages& stages) {
    try {
      stages();
    } catch (const Ended&) {
      made_.result.mesh = {};
    }
  }

  void mesh(const Plc& plc, std::uint64_t seed) {
    plc_ = &plc;
    options_ = given_;
    if (source_ != nullptr) source_->adapt(plc, options_);
    require_known_tags(options_.mesh, plc);
    require_known_patches(options_.split, plc);
    options_.mesh.bounds.tolerance = nearer_ ? *nearer_ : tolerance(plc);
    const double distance = options_.mesh.bounds.tolerance->largest();
    require_periodic_patches(options_.periodic, plc, distance);
    if (options_.periodic.any())
      options_.mesh.bounds.tolerance =
          periodicity::tolerance_across(*options_.mesh.bounds.tolerance, plc, options_.periodic, distance);
    if (!knows_bound_) find_bound();
    if (most_vertices_ > 0) options_.mesh.max_vertices = most_vertices_;
    options_.mesh.seed = seed;
    refined_with_ = options_of_refinement();
    if (start_ == Start::constrained)
      tetrahedralize();
    else
      refine();
    if (is_far_too_fine() && replace_refined()) return;
    reshape();
    if (start_ == Start::constrained) settle();
    make_faces_periodic();
    project();
    raise_order();
    certify();
  }

  /// Returns whether a refinement made many times the tets that are to be left, as thin parts make it do. To
  /// coarsen those away takes far longer than to begin with constrained tetrahedra.
  bool is_far_too_fine() const {
    constexpr double times = 5, least = 200'000;
    const auto tets = static_cast<double>(made_.result.mesh.tets.size());
    return start_ == Start::automatic && options_.coarsen && made_.result.status == MeshStatus::complete &&
           tets > least && tets > times * prediction::count_tets(prediction::Shape(*plc_), options_.mesh);
  }

  /// Takes the mesh from the constrained tetrahedra in place of the refined one if it keeps every guarantee.
  bool replace_refined() {
    KnownNeighbours neighbours = std::move(neighbours_);
    const MeshOptions refined_with = refined_with_;
    if (take_constrained(*plc_, fmt::format("the refinement makes {} tets", made_.result.mesh.tets.size())))
      return true;
    neighbours_ = std::move(neighbours);
    refined_with_ = refined_with;
    return false;
  }

  bool exact() const { return static_cast<bool>(options_.exact); }

  /// Returns the bounds of the finished mesh.
  Bounds bounds() const {
    Bounds bounds = options_.mesh.bounds;
    bounds.lower_where_forced = made_.result.has_narrow_cells;
    if (!made_.coarsening) bounds.thin_angle = 0;
    return bounds;
  }

  /// Keeps the mesh within tighter bounds where its vertices move onto exact geometry afterwards.
  MeshOptions options_of_refinement() const {
    MeshOptions options = options_.mesh;
    options.time_limit = 0;  // one limit for all stages
    if (options_.coarsen) options.narrow_cells = narrow_cells_;
    if (!exact()) return options;
    options.bounds.tolerance = tolerance_of(*plc_, options.bounds, 0).scaled(distance_left);
    if (options.profile == Profile::standard)  // the paper proves nothing for smaller ones than its own
      options.bounds.radius_edge = std::max(1.0, ratio_left * options.bounds.radius_edge);
    options.bounds.reserve = angle_reserve;
    return options;
  }

  void refine() {
    begin("refine", 0.06, options_.coarsen ? 0.6 : 0.7);
    MeshOptions options = refined_with_;
    options.bounds.interior_node = false;  // nodes are inserted afterwards
    if (options_.coarsen)
      options.bounds.collar_angle = std::max(options.bounds.collar_angle, reached_collar_angle);
    MeshResult& result = made_.result =
        generate(*plc_, options, inner_, neighbours_, options_.trace ? &made_.trace : nullptr);
    if (result.status == MeshStatus::cancelled && out_of_time()) stop();
    if (hit_bound())
      result.message = describe_explosion(*plc_, most_vertices_, result.where) +
                       "; mend what nearly meets there, raise the repair tolerance (repair-tolerance), wrap "
                       "it (repair wrap), or let it go on (max-vertices)";
    if (result.status == MeshStatus::cancelled || result.status == MeshStatus::budget_hit) throw Ended();
    refined_with_.bounds.lower_where_forced = result.has_narrow_cells;
  }

  /// Makes the constrained tetrahedra of the complex, and brings them to the size.
  void tetrahedralize() {
    begin("tetrahedralize", 0.06, 0.2);
    MeshResult& result = made_.result;
    neighbours_ = KnownNeighbours();
    watch([&](const Execution& watched) { result.mesh = constrained_tetrahedra(*plc_, watched).mesh; });
    begin("remesh", 0.2, 0.6);
    result.has_narrow_cells = refined_with_.bounds.lower_where_forced = true;
    bool brought = false;
    watch([&](const Execution& watched) {
      brought = remeshing::bring_to_size(result.mesh, *plc_, refined_with_, watched);
    });
    if (brought) return;
    result.status = MeshStatus::budget_hit;
    result.message =
        fmt::format("{} vertices were reached; raise max-vertices, or the sizes for a coarser mesh",
                    refined_with_.max_vertices);
    throw Ended();
  }

  /// Runs a stage that ends early, without saying so, when progress says so.
  template <class Stage>
  void watch(const Stage& stage) {
    Execution watched = inner_;
    bool stopped = false;
    if (inner_.progress)
      watched.progress = [&](const ProgressReport& report) {
        stopped |= !inner_.progress(report);
        return !stopped;
      };
    stage(watched);
    if (stopped) stop();
    stop_if_asked();
  }

  /// Tets beyond the bounds get better where all is done once more, as long as that makes them fewer.
  void settle() {
    constexpr unsigned most_rounds = 4;
    constexpr std::size_t tets_per_poor = 50;
    if (refined_with_.bounds.interior_node) return;  // the nodes are there
    std::size_t least = misshapen(made_.result.mesh);
    if (hope_ == Hope::good && tets_per_poor * least > made_.result.mesh.tets.size()) throw Hopeless();
    for (unsigned round = 0; round < most_rounds && least > 0; ++round) {
      TetMesh mesh = made_.result.mesh;
      const auto before = made_.improvement;
      watch([&](const Execution& watched) { remeshing::relax(mesh, *plc_, refined_with_, watched); });
      coarsen_and_improve(mesh, {});
      const std::size_t poor = misshapen(mesh);
      if (poor >= least) {
        made_.improvement = before;
        return;
      }
      least = poor;
      made_.result.mesh = std::move(mesh);
    }
  }

  /// Coarsening and improvement work on one data structure.
  void reshape() {
    if ((!options_.coarsen && options_.improve == 0) || made_.result.status != MeshStatus::complete) {
      neighbours_ = KnownNeighbours();
      return;
    }
    if (options_.coarsen)
      begin("coarsen", 0.6, 0.7);
    else
      begin("improve", 0.7, 0.8);
    TetMesh& mesh = made_.result.mesh;
    insert_interior_nodes();
    if (given_.periodic.any()) refined_ = mesh;
    ThreadLimit(options_.mesh.threads).run([&] {
      improvement::Workpiece workpiece(mesh, *plc_, *refined_with_.bounds.tolerance,
                                       options_.coarsen ? refined_with_.edges_per_hole : 0,
                                       refined_with_.bounds.lower_where_forced, neighbours_);
      neighbours_ = KnownNeighbours();
      if (options_.coarsen) coarsen_elements(workpiece);
      if (options_.improve > 0) improve_elements(workpiece);
      complete_interior_nodes(workpiece);
      workpiece.complex.store();
      if (options_.coarsen) improvement::mark_cells(mesh, *plc_, refined_with_.bounds);
    });
    trace(options_.improve > 0 ? "improve" : "coarsen", mesh);
  }

  /// Those that are not needed are coarsened away again.
  void insert_interior_nodes() {
    if (!refined_with_.bounds.interior_node) return;
    improvement::Workpiece workpiece(made_.result.mesh, *plc_, *refined_with_.bounds.tolerance, 0,
                                     refined_with_.bounds.lower_where_forced, neighbours_);
    neighbours_ = KnownNeighbours();
    made_.interior_nodes.emplace();
    improvement::insert_interior_nodes(workpiece, refined_with_.bounds, *made_.interior_nodes);
    workpiece.complex.store();
  }

  void complete_interior_nodes(improvement::Workpiece& workpiece) {
    if (refined_with_.bounds.interior_node)
      improvement::complete_interior_nodes(workpiece, refined_with_.bounds, *made_.interior_nodes);
  }

  /// Gives the refined mesh the nodes of another one, the source, on both sides of each pair, coarsens it
  /// with these, and makes the triangles alike. Then the tets beside them are coarsened and improved
  /// together, while the mesh is cut open elsewhere. If some stay poor, curves are divided there, and all is
  /// done again with these nodes. The source is the coarsened mesh, but first, if there are smooth patches,
  /// the refined one: wedges that these make with the sides need their nodes on both sides.
  void make_faces_periodic() {
    if (!given_.periodic.any() || made_.result.status != MeshStatus::complete) return;
    constexpr unsigned most_tries = 4, most_rounds = 3;
    begin("periodic faces", 0.75, 0.79);
    const ImproveReport improvement = made_.improvement;
    const bool smooth = std::ranges::any_of(plc_->patches, [](const auto& patch) { return !patch.planar; });
    TetMesh best, source = std::move(made_.result.mesh);
    std::size_t least = SIZE_MAX;
    for (unsigned k = 0; k < most_tries && least > 0; ++k) {
      TetMesh mesh = refined_with_nodes_of(smooth && k == 0 ? refined_ : source);
      const PeriodicReport report =
          make_periodic(mesh, *plc_, options_.periodic, refined_with_.bounds.tolerance->largest());
      periodicity::map_corners(mesh);
      std::size_t before = SIZE_MAX;
      for (unsigned round = 0; round < most_rounds; ++round) {
        const std::size_t poor = reshape_across(mesh, k > 0 || round > 0);
        if (poor < least) {
          least = poor;
          best = mesh;
          made_.periodic = report;
        }
        if (poor == 0 || poor >= before) break;
        divide_curves_at_poor_tets(mesh);
        if (before == SIZE_MAX && !(smooth && k == 0)) source = mesh;
        before = poor;
      }
    }
    refined_ = {};
    made_.improvement = improvement;
    made_.result.mesh = std::move(best);
    trace("periodic faces", made_.result.mesh);
  }

  TetMesh refined_with_nodes_of(const TetMesh& source) {
    TetMesh mesh = refined_;
    coarsen_and_improve(mesh, periodicity::add_periodic_nodes(mesh, source, *plc_, options_.periodic,
                                                              refined_with_.bounds.tolerance->largest()));
    return mesh;
  }

  void divide_curves_at_poor_tets(TetMesh& mesh) {
    change_across(mesh, periodicity::Recut::Moved::beside_first,
                  [&](improvement::Workpiece& workpiece, const auto&) {
                    improvement::divide_curves_at_poor_tets(workpiece, refined_with_.bounds);
                  });
  }

  using Moved = periodicity::Recut::Moved;

  template <class Change>
  void change_across(TetMesh& mesh, Moved moved, const Change& change) {
    const SurfaceTolerance& tolerance = *refined_with_.bounds.tolerance;
    ThreadLimit(options_.mesh.threads).run([&] {
      periodicity::change_across(mesh, *plc_, options_.periodic, tolerance.largest(), tolerance, moved,
                                 refined_with_.edges_per_hole, change);
      improvement::mark_cells(mesh, *plc_, refined_with_.bounds);
    });
  }

  /// Coarsens and improves a periodic mesh while it is cut open at one place and then at another; vertices
  /// are inserted if asked for. Returns how often its tets miss their bounds.
  std::size_t reshape_across(TetMesh& mesh, bool insert) {
    std::size_t poor = SIZE_MAX;
    for (const Moved moved : {Moved::beside_first, Moved::beside_second}) {
      change_across(mesh, moved, [&](improvement::Workpiece& workpiece, const periodicity::Recut& recut) {
        MeshOptions options = refined_with_;
        options.size_field = recut.sizes(options.size_field);
        if (coarsen(workpiece, options, inner_).cancelled) stop();
        if (options_.improve > 0) improve_elements(workpiece);
        if (insert) insert_where_poor(workpiece);
        complete_interior_nodes(workpiece);
      });
      poor = misshapen(mesh);
      if (poor == 0) break;
    }
    return poor;
  }

  /// Where tets still miss their bounds, or nearly so, vertices may come and go.
  void insert_where_poor(improvement::Workpiece& workpiece) {
    constexpr double nearly = 1.25;
    if (options_.improve == 0) return;
    ImproveOptions options = options_of_improvement();
    options.keep_vertices = false;
    options.min_dihedral = std::min(options.min_dihedral, nearly * options.bounds.thin_angle);
    if (improve(workpiece, options, inner_).cancelled) stop();
  }

  /// Fixed vertices stay where they are.
  void coarsen_and_improve(TetMesh& mesh, const std::vector<Index>& fixed) {
    ThreadLimit(options_.mesh.threads).run([&] {
      improvement::Workpiece workpiece(mesh, *plc_, *refined_with_.bounds.tolerance,
                                       refined_with_.edges_per_hole, refined_with_.bounds.lower_where_forced);
      workpiece.fix(fixed);
      if (coarsen(workpiece, refined_with_, inner_).cancelled) stop();
      if (options_.improve > 0) improve_elements(workpiece);
      workpiece.complex.store();
      improvement::mark_cells(mesh, *plc_, refined_with_.bounds);
    });
  }

  /// Returns how often tets miss the bounds on their shapes, or sides of pairs their images, which counts far
  /// more. Precondition: the map has the corners.
  std::size_t misshapen(const TetMesh& mesh) const {
    Bounds promised = bounds();
    promised.tolerance = refined_with_.bounds.tolerance;
    const CheckReport report = check(mesh, *plc_,
                                     {.bounds = promised,
                                      .findings_per_guarantee = std::numeric_limits<std::size_t>::max(),
                                      .threads = options_.mesh.threads},
                                     inner_);
    const auto poor = static_cast<std::size_t>(std::ranges::count_if(report.findings, is_about_shape));
    // Places are only exact when the mesh is finished.
    constexpr std::size_t worse = 1000;  // than a tet
    CheckReport of_pairs;
    checks::check_periodic(mesh, of_pairs);
    return poor +
           worse * static_cast<std::size_t>(std::ranges::count_if(of_pairs.findings, [](const Finding& f) {
             return f.guarantee == guarantee::periodic_nodes || f.guarantee == guarantee::periodic_edges ||
                    f.guarantee == guarantee::periodic_faces;
           }));
  }

  void coarsen_elements(improvement::Workpiece& workpiece) {
    made_.coarsening = coarsen(workpiece, refined_with_, inner_);
    if (made_.coarsening->cancelled) stop();
    if (!options_.trace || options_.improve == 0) return;
    TetMesh coarsened = workpiece.complex.stored();
    improvement::mark_cells(coarsened, *plc_, refined_with_.bounds);
    trace("coarsen", coarsened);
  }

  /// Adds a mesh to the trace, if there is to be one.
  void trace(std::string_view stage, const TetMesh& mesh) {
    if (options_.trace) made_.trace.push_back(traced_mesh(mesh, std::string(stage)));
  }

  void improve_elements(improvement::Workpiece& workpiece) {
    if (made_.coarsening) begin("improve", 0.7, 0.8);
    const ImproveOptions options = options_of_improvement();
    made_.improvement = improve(workpiece, options, inner_);
    if (made_.improvement.cancelled) stop();
  }

  ImproveOptions options_of_improvement() const {
    ImproveOptions options = improve_options(options_.improve);
    options.bounds = refined_with_.bounds;
    options.bounds.thin_angle = bounds().thin_angle;
    options.threads = options_.mesh.threads;
    if (made_.coarsening) {
      // Just above the bound a tet may be within it once its vertices have moved onto the exact geometry.
      options.thin_above = options_.mesh.bounds.radius_edge / (exact() ? ratio_left : 1);
      options.keep_vertices = start_ != Start::constrained;
    }
    if (options_.min_dihedral > 0) options.min_dihedral = options_.min_dihedral;
    if (exact()) options.min_dihedral *= 1 + dihedral_reserve;
    return options;
  }

  void project() {
    if (!exact() || made_.result.status != MeshStatus::complete) return;
    begin("project", 0.8, 0.83);
    const ProjectOptions options{.bounds = bounds(), .threads = options_.mesh.threads};
    made_.projection = project_boundary(made_.result.mesh, *plc_, options_.exact, options, inner_);
    trace("project", made_.result.mesh);
  }

  void raise_order() {
    if (options_.order == 1) return;
    begin("second order", 0.83, 0.86);
    const SecondOrderOptions options{
        .exact = options_.exact, .bounds = bounds(), .threads = options_.mesh.threads};
    made_.second_order = make_second_order(made_.result.mesh, *plc_, options, inner_);
    if (made_.second_order.cancelled) stop();
  }

  void certify() {
    begin("check", 0.86, given_.partitions > 0 ? 0.96 : 1);
    Bounds promised = bounds();
    promised.tolerance = tolerance(*plc_);
    if (made_.periodic) periodicity::finish_map(made_.result.mesh, *made_.periodic);
    made_.check = check(
        made_.result.mesh, *plc_,
        {.bounds = promised, .exact = options_.exact_measures, .threads = options_.mesh.threads}, inner_);
    if (!made_.result.mesh.periodic.empty()) checks::check_periodic(made_.result.mesh, made_.check);
    stop_if_asked();
  }

  /// Called once, for the mesh that is kept.
  void divide() {
    if (given_.partitions == 0) return;
    begin("partition", 0.96, 1);
    partition(made_.result.mesh, given_.partitions);
    stop_if_asked();
  }

  /// Called once, after the mesh was certified as it is before.
  void split_patches() {
    if (!given_.split.any()) return;
    begin("split", 0.98, 1);
    TetMesh& mesh = made_.result.mesh;
    const checks::SplitMeasures before = checks::measure_before_split(mesh);
    if (exact()) mesh.group_names = GroupNames::cad;  // for the names of the sides
    made_.split = split(mesh, options_.split);
    checks::check_split(mesh, made_.split->interfaces.sides, before, made_.check);
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

  /// Forwards the progress of a stage, scaled to its share of the whole.
  bool go_on(ProgressReport report) {
    fraction_ = std::max(fraction_, from_ + std::clamp(report.fraction, 0.0, 1.0) * (to_ - from_));
    report.fraction = fraction_;
    return outer_.progress(report);
  }

  /// Says whether it was the time that stopped a run.
  template <class Result>
  Result told_of_time(Result made) const {
    if (made.result.status != MeshStatus::cancelled || !out_of_time()) return made;
    made.result.status = MeshStatus::budget_hit;
    made.result.message = fmt::format(
        "the time limit of {} s is reached; raise it, or size for a coarser mesh", given_.mesh.time_limit);
    return made;
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

  const PipelineOptions given_;
  PipelineOptions options_;          // for the complex at hand
  ComplexSource* source_ = nullptr;  // unless there is one complex only
  NarrowCells narrow_cells_ = NarrowCells::bounded_if_cheap;
  Ways ways_ = Ways::none;  // that are left
  Start start_;             // of the mesh at hand
  Hope hope_ = Hope::any;
  bool is_constrained_ = false;    // the mesh that is kept
  const Plc* hopeless_ = nullptr;  // this complex's constrained tetrahedra were tried in vain
  bool knows_bound_ = false;       // for them, on vertices
  std::size_t most_vertices_ = 0;  // of a refinement, in place of the given budget; 0: that
  const Execution& outer_;
  Execution inner_;
  ThreadCounter counter_;
  std::optional<Deadline> deadline_;
  MeshOptions refined_with_;
  TetMesh refined_;             // as it was before it was coarsened, for periodic faces
  KnownNeighbours neighbours_;  // of the mesh as it was refined
  const Plc* plc_ = nullptr;
  std::optional<SurfaceTolerance> tolerance_;  // of the complex at hand
  std::optional<SurfaceTolerance> nearer_;     // what a further try keeps where regions lost volume
  PipelineResult made_;
  std::string_view stage_;
  double from_ = 0, to_ = 0, fraction_ = 0;  // of the stage in the whole
};

}  // namespace

std::string PipelineResult::missed() const {
  if (!result.message.empty() || check.findings.empty()) return result.message;
  return check.findings.front().message;
}

double distance_of(const PipelineOptions& options, double diagonal) {
  return options.mesh.bounds.distance > 0
             ? options.mesh.bounds.distance
             : default_distance(options.mesh.size, diagonal, static_cast<int>(options.order));
}

SoupPipelineResult run_pipeline(ComplexSource& source, const PipelineOptions& options,
                                const Execution& execution) {
  return Pipeline(options, execution).run(source);
}

SoupPipelineResult run_pipeline(std::span<const PolygonSoup> soups, const PipelineOptions& options,
                                const Execution& execution) {
  SoupSource source(soups, options.complex);
  return run_pipeline(source, options, execution);
}

PipelineResult run_pipeline(const Plc& plc, const PipelineOptions& options, const Execution& execution) {
  return Pipeline(options, execution).run(plc);
}

}  // namespace collarmesh
