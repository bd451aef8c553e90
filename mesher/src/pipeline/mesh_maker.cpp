#include "pipeline/mesh_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "adapt/bring_to_size.h"
#include "collarmesh/error.h"
#include "common/disjoint_sets.h"
#include "common/sort_uniquely.h"
#include "common/thread_limit.h"
#include "periodic/make_periodic.h"
#include "periodic/tolerance_across.h"
#include "pipeline/certification.h"
#include "pipeline/periodic_faces.h"
#include "pipeline/reshaping.h"
#include "pipeline/rods_in_blocks.h"
#include "pipeline/vertex_bound.h"
#include "predict/vertex_counts.h"
#include "tolerance/thin_shells.h"

namespace collarmesh::pipeline {

namespace {

/// For thin shells, a refinement that needs more vertices than this takes longer than constrained tetrahedra.
constexpr std::size_t few_vertices = 15'000;

/// Moves the vertices of a complete mesh onto the exact geometry, if there is any.
void project(MeshJob& job) {
  if (!job.exact() || job.made.result.status != MeshStatus::complete) return;
  job.control.begin("project", 0.8, 0.83);
  const ProjectOptions options{.bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.projection =
      project_boundary(job.made.result.mesh, *job.plc, job.options.exact, options, job.execution());
  job.trace("project", job.made.result.mesh);
}

/// Adds mid-edge nodes and curves the cells, if the options ask for second order.
void raise_order(MeshJob& job) {
  if (job.options.order == 1) return;
  job.control.begin("second order", 0.83, 0.86);
  const SecondOrderOptions options{
      .exact = job.options.exact, .bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.second_order = make_second_order(job.made.result.mesh, *job.plc, options, job.execution());
  if (job.made.second_order.cancelled) job.control.stop();
}

/// Returns the number of vertices that are corners of tets, not mid-edge nodes.
std::size_t corner_count(const TetMesh& mesh) {
  std::vector<Index> corners;
  for (const auto& tet : mesh.tets) corners.insert(corners.end(), tet.begin(), tet.end());
  sort_uniquely(corners);
  return corners.size();
}

/// Returns sets of patches that unite the two smooth patches of each wall, layer or shell. Volumes that
/// chords cut off on both sides cancel only if the chords are equally long.
DisjointSets sides_of_walls(const Plc& plc) {
  std::vector<std::vector<Index>> smooth(plc.regions.size());
  for (Index p = 0; p < plc.patches.size(); ++p)
    if (const auto& regions = plc.patches[p].regions; !plc.patches[p].planar && regions[0] != regions[1])
      for (const Index r : regions) smooth[r].push_back(p);
  DisjointSets walls(plc.patches.size());
  for (Index r = 1; r < plc.regions.size(); ++r)
    if (smooth[r].size() == 2) walls.unite(smooth[r][0], smooth[r][1]);
  return walls;
}

}  // namespace

void MeshMaker::make(const Plc& plc, std::uint64_t seed) {
  set_up(plc, seed);
  if (take_rods() || take_sheathed_rods()) return;
  if (may_be_better_constrained()) {
    if (!refines_with_few_vertices() &&
        take_constrained(
            plc, "curved walls or gaps that are far thinner than the elements may take too many vertices",
            Lengths::kept))
      return;
    set_up(plc, seed);
  }
  if (job_.start == Start::constrained)
    tetrahedralize(job_, hope_);
  else
    refine(job_, fineness_);
  const bool too_fine = is_far_too_fine();
  if (too_fine && replace_refined()) return;
  was_far_too_fine_ = too_fine;
  reshape(job_);
  if (job_.start == Start::constrained)
    settle(job_, hope_);
  else
    mend_flat_tets(job_);
  make_faces_periodic(job_);
  project(job_);
  raise_order(job_);
  certify(job_, tolerance(plc));
  if (job_.start != Start::constrained) is_constrained_ = false;
}

void MeshMaker::set_up(const Plc& plc, std::uint64_t seed) {
  job_.plc = &plc;
  PipelineOptions& options = job_.options;
  options = job_.given;
  if (source_ != nullptr) source_->adapt(plc, options);
  require_known_tags(options.mesh, plc);
  require_known_patches(options.split, plc);
  require_known_walls(options.layers, plc);
  options.mesh.bounds.tolerance = nearer_ ? *nearer_ : tolerance(plc);
  const double distance = options.mesh.bounds.tolerance->largest();
  require_periodic_patches(options.periodic, plc, distance);
  if (options.periodic.any())
    options.mesh.bounds.tolerance =
        periodicity::tolerance_across(*options.mesh.bounds.tolerance, plc, options.periodic, distance);
  job_.budget.find(plc, options);
  if (job_.budget.most() > 0) options.mesh.max_vertices = job_.budget.most();
  options.mesh.seed = seed;
  job_.refined_with = options_of_refinement(job_, narrow_cells_);
}

/// Uses tetrahedra between rings of vertices if all bodies are thin rods and every guarantee holds.
bool MeshMaker::take_rods() {
  if (no_rods_ == job_.plc || job_.start != Start::automatic || !may_have_rods(job_)) return false;
  PipelineResult before = std::exchange(job_.made, {});
  if (fill_rods(job_)) {
    project(job_);
    raise_order(job_);
    certify(job_, tolerance(*job_.plc));
    if (job_.made.guarantees_hold()) {
      is_constrained_ = true;
      job_.made.check.notes.push_back(
          "made of rings of vertices around rods, which are far thinner than the elements");
      return true;
    }
  }
  no_rods_ = job_.plc;
  job_.made = std::move(before);
  return false;
}

/// Uses rings in and around thin rods inside other regions, and a refinement of the rest, if there are such
/// rods and every guarantee holds. Otherwise leaves the job as it was.
bool MeshMaker::take_sheathed_rods() {
  if (no_sheaths_ == job_.plc || job_.start != Start::automatic || !may_have_rods(job_)) return false;
  std::vector<SheathedRod> rods = find_sheathed_rods(job_);
  if (rods.empty()) return false;
  PipelineResult before = std::exchange(job_.made, {});
  if (is_good_with_sheaths(rods)) {
    is_constrained_ = false;
    job_.made.check.notes.push_back(
        fmt::format("made of rings of vertices in and around rods that are far thinner than the elements; "
                    "number of rods: {}",
                    rods.size()));
    return true;
  }
  no_sheaths_ = job_.plc;
  job_.made = std::move(before);
  set_up(*job_.plc, job_.options.mesh.seed);
  return false;
}

/// Makes a mesh with sheaths around rods. Removes from the list the rods that get no sheath. Returns whether
/// every guarantee holds.
bool MeshMaker::is_good_with_sheaths(std::vector<SheathedRod>& rods) {
  try {
    std::vector<Index> fixed;
    const std::size_t most = job_.refined_with.max_vertices;
    if (may_be_better_constrained() && (most == 0 || most > few_vertices))
      job_.refined_with.max_vertices = few_vertices;
    if (!refine_around_rods(job_, rods, fixed, fineness_)) return false;
    job_.refined_with.max_vertices = most;
    reshape(job_, fixed);
    mend_flat_tets(job_);
    project(job_);
    raise_order(job_);
    certify(job_, tolerance(*job_.plc));
    return job_.made.guarantees_hold();
  } catch (const Ended&) {
    if (!job_.budget.ended_at_vertices(job_.made.result, job_.control.out_of_time())) throw;
  } catch (const FarTooFine&) {  // the refinement of the whole complex decides
  } catch (const PlcError&) {    // vertices on axes are too near to other features
  }
  return false;
}

/// Returns whether a refinement probably makes many times the elements that are needed. Returns true also for
/// cylinders that nearly touch, where it makes few elements; so `refines_with_few_vertices` decides
/// afterwards.
bool MeshMaker::may_be_better_constrained() const {
  if (job_.start != Start::automatic || !may_start_constrained(job_.given) ||
      !may_take_constrained(*job_.plc))
    return false;
  const double size = smallest_size(job_.options.mesh, job_.plc->bounds.diagonal());
  return has_thin_shells(*job_.plc, *job_.options.mesh.bounds.tolerance, size);
}

/// Refines with a limit on vertices, beyond which constrained tetrahedra would be faster. Returns whether the
/// refinement ended below this limit. The mesh is not used, because the limit changes the order of
/// insertions.
bool MeshMaker::refines_with_few_vertices() {
  const std::size_t most = job_.refined_with.max_vertices;
  if (most > 0 && most <= few_vertices) return false;
  job_.refined_with.max_vertices = few_vertices;
  try {
    refine(job_);
  } catch (const Ended&) {
    if (!job_.budget.ended_at_vertices(job_.made.result, job_.control.out_of_time())) throw;
    return false;
  }
  return true;
}

/// Returns whether a refinement made many times the predicted number of tets, as it does at thin parts.
/// Coarsening such a mesh takes far longer than starting with constrained tetrahedra.
bool MeshMaker::is_far_too_fine() const {
  constexpr double times = 15, least = 60'000;
  const auto tets = static_cast<double>(job_.made.result.mesh.tets.size());
  const auto is_predicted = [&](double wanted) {
    return prediction::count_tets(prediction::Shape(*job_.plc), job_.options.mesh, {}, wanted) >= wanted;
  };
  return job_.start == Start::automatic && job_.options.coarsen &&
         job_.made.result.status == MeshStatus::complete && tets > least && !is_predicted(tets / times);
}

/// Replaces the refined mesh by one made from the constrained tetrahedra, if that keeps every guarantee.
bool MeshMaker::replace_refined() {
  KnownNeighbours neighbours = std::move(job_.neighbours);
  const MeshOptions refined_with = job_.refined_with;
  if (take_constrained(*job_.plc,
                       fmt::format("the refinement makes {} tets, many times as many as the sizes ask for",
                                   job_.made.result.mesh.tets.size())))
    return true;
  job_.neighbours = std::move(neighbours);
  job_.refined_with = refined_with;
  return false;
}

void MeshMaker::make_anyhow(const Plc& plc, const std::string& why, std::size_t tried) {
  if (take_constrained(plc, why)) return;
  const std::optional<SurfaceTolerance> nearer = nearer_;
  std::optional<PipelineResult> constrained = take_nearly_good();
  const bool comes_first = has_few_triangles(plc),
             may_follow = !comes_first && may_start_constrained(job_.given);
  if (!constrained && comes_first) constrained = from_constrained(plc, why, Hope::any);
  std::optional<SurfaceTolerance> nearer_of_constrained = std::exchange(nearer_, nearer);
  const auto use = [&] {
    nearer_ = nearer_of_constrained;
    use_constrained(std::move(*constrained));
  };
  if (constrained && constrained->guarantees_hold()) return use();
  if (constrained || may_follow) job_.budget.bound(Ways::constrained);
  if (constrained) job_.budget.compare_with(constrained_vertices_);
  bool is_refined = refines_within_budgets(plc, tried, constrained.has_value());
  job_.budget.bound(Ways::none);
  if (!is_refined && may_follow) {
    constrained = from_constrained(plc, why, Hope::any);
    nearer_of_constrained = std::exchange(nearer_, nearer);
    is_refined = !constrained && refines_within_budgets(plc, tried, false);
  }
  job_.budget.find(plc, job_.options);
  if (!is_refined && !constrained) throw Ended();
  if (constrained && (!is_refined || misses_far_less(*constrained, job_.made))) use();
}

void MeshMaker::use_constrained(PipelineResult constrained) {
  job_.made = std::move(constrained);
  job_.promised = job_.bounds();
  job_.promised.tolerance = tolerance(*job_.plc);
  is_constrained_ = true;
  constrained_.reset();
}

/// Refines a complex if more vertices are allowed than `tried`. Returns whether this made a mesh. If there is
/// another mesh, takes at most half of the remaining time.
bool MeshMaker::refines_within_budgets(const Plc& plc, std::size_t tried, bool has_mesh) {
  constexpr double share_of_time = 0.5;
  bool is_refined = false;
  const auto refine_and_reshape = [&] {
    set_up(plc, job_.given.mesh.seed);
    if (const std::size_t most = job_.budget.most(); most > 0 && most <= tried) return;
    make(plc, job_.given.mesh.seed);
    is_refined = true;
  };
  const auto require_another_way = [&] {
    if (job_.made.result.status == MeshStatus::cancelled || !(has_mesh || job_.hit_bound())) throw;
  };
  try {
    if (has_mesh)
      job_.control.attempt(share_of_time, refine_and_reshape);
    else
      refine_and_reshape();
  } catch (const Ended&) {
    require_another_way();
  } catch (const PlcError&) {
    require_another_way();
  } catch (const std::bad_alloc&) {
    require_another_way();
  }
  return is_refined;
}

bool MeshMaker::has_few_triangles(const Plc& plc) {
  constexpr std::size_t most_triangles = 12'000;  // with more triangles, other ways are faster
  return plc.triangles.size() <= most_triangles;
}

bool MeshMaker::may_take_constrained(const Plc& plc) const {
  return has_few_triangles(plc) && hopeless_ != &plc;
}

bool MeshMaker::take_constrained(const Plc& plc, const std::string& why, Lengths lengths) {
  if (!may_take_constrained(plc)) return false;
  const std::optional<SurfaceTolerance> nearer = nearer_;
  std::optional<PipelineResult> constrained = from_constrained(plc, why, Hope::good);
  const bool has_lengths =
      constrained && (lengths == Lengths::any ||
                      keeps_lengths(constrained->result.mesh,
                                    smallest_size(job_.options.mesh, job_.plc->bounds.diagonal())));
  is_constrained_ = has_lengths && constrained->guarantees_hold();
  hopeless_ = is_constrained_ ? nullptr : &plc;
  constrained_.reset();
  if (is_constrained_) {
    job_.made = std::move(*constrained);
    constrained_ = Constrained{why, lengths};
  } else {
    nearer_ = nearer;
    if (has_lengths) nearly_good_ = std::move(constrained);
  }
  return is_constrained_;
}

void MeshMaker::make_again(const Plc& plc, std::uint64_t seed) {
  if (!prefers_constrained()) return make(plc, seed);
  const Constrained before = *constrained_;
  if (take_constrained(plc, before.why, before.lengths)) return;
  // The kept mesh stays.
  constrained_ = before;
  is_constrained_ = true;
  hopeless_ = nullptr;
  throw Hopeless();
}

std::optional<PipelineResult> MeshMaker::from_constrained(const Plc& plc, const std::string& why, Hope hope) {
  const PipelineOptions& given = job_.given;
  if (!may_start_constrained(given)) return {};
  PipelineResult& made = job_.made;
  PipelineResult before = std::exchange(made, {});
  std::optional<PipelineResult> found;
  job_.start = Start::constrained;
  hope_ = hope;
  const std::unique_ptr<MeshMaker, void (*)(MeshMaker*)> restore(this, [](MeshMaker* maker) {
    maker->job_.start = Start::automatic;
    maker->hope_ = Hope::any;
  });
  const std::optional<SurfaceTolerance> nearer = nearer_;
  try {
    make(plc, given.mesh.seed);
    const Bounds& bounds = given.mesh.bounds;
    if (misses_volumes_only(made.check) && !(bounds.distance > 0) && !bounds.tolerance) {
      constexpr double share = 0.25;
      come_nearer(plc, share);
      make(plc, given.mesh.seed);
    }
    try_seeds_of_constrained(plc);
    made.check.notes.push_back(
        fmt::format("begun with constrained tetrahedra, because without them: {}", why));
    constrained_vertices_ = corner_count(made.result.mesh);
    if (std::ranges::all_of(made.check.findings, is_about_shape)) found = std::move(made);
  } catch (const Hopeless&) {
    constrained_vertices_ = corner_count(made.result.mesh);
    found.reset();
  } catch (const PlcError&) {
    found.reset();
  } catch (const Ended&) {
    if (!job_.hit_bound()) throw;
  }
  if (!found) nearer_ = nearer;
  made = std::move(before);
  return found;
}

void MeshMaker::try_seeds_of_constrained(const Plc& plc) {
  constexpr std::size_t few = 20;
  constexpr unsigned most = remeshing::adapting::different_seeds;
  constexpr double share_of_time = 0.5;
  PipelineResult& made = job_.made;
  const auto misses_shapes_only = [](const CheckReport& check) {
    return std::ranges::all_of(check.findings, is_about_shape);
  };
  const std::uint64_t first = job_.given.mesh.seed, end = first + std::min(job_.given.seeds, most);
  std::uint64_t seed_of_kept = first;
  for (std::uint64_t seed = first + 1; seed < end && !made.guarantees_hold(); ++seed) {
    if (made.check.findings_total > few || !misses_shapes_only(made.check)) return;
    PipelineResult kept = std::exchange(made, {});
    bool better = false;
    try {
      job_.control.attempt(share_of_time, [&] {
        make(plc, seed);
        better = misses_shapes_only(made.check) && made.check.findings_total < kept.check.findings_total;
      });
    } catch (const Hopeless&) {
    } catch (const PlcError&) {
    } catch (const std::bad_alloc&) {
    } catch (const Ended&) {
      if (made.result.status == MeshStatus::cancelled) throw;
    }
    if (better) {
      made.check.notes.push_back(
          fmt::format("made with seed {}, because with seed {}: {}", seed, seed_of_kept, kept.missed()));
      seed_of_kept = seed;
    } else {
      made = std::move(kept);
    }
  }
}

void MeshMaker::take_new_complex() {
  tolerance_.reset();
  nearer_.reset();
  no_rods_ = nullptr;
  no_sheaths_ = nullptr;
  hopeless_ = nullptr;
  constrained_.reset();
  nearly_good_.reset();
  constrained_vertices_ = 0;
}

void MeshMaker::move_to(const Plc& plc) {
  if (std::exchange(job_.plc, &plc) == &plc) return;
  if (source_ != nullptr && job_.options.exact)
    source_->adapt(plc, job_.options);  // exact geometry refers to the complex
}

void MeshMaker::come_nearer(const Plc& plc, double share) { nearer_ = tolerance(plc, 1).scaled(share); }

void MeshMaker::come_nearer(const Plc& plc, const std::vector<double>& shares) {
  constexpr double as_near = 1.2;  // tolerances of two sides count as equal up to this ratio
  const SurfaceTolerance base = nearer_ ? *nearer_ : tolerance(plc, 1);
  struct Wall {
    double least = INFINITY, most = 0;
    bool comes_nearer = false;
  };
  DisjointSets sides = sides_of_walls(plc);
  std::vector<Wall> walls(plc.patches.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    if (plc.patches[p].planar) continue;
    auto& [least, most, comes_nearer] = walls[sides.find(p)];
    least = std::min(least, base.largest_on_patch(p));
    most = std::max(most, base.largest_on_patch(p));
    comes_nearer |= shares[p] < 1;
  }
  std::vector<double> triangles(plc.triangles.size());
  for (Index t = 0; t < triangles.size(); ++t) {
    const Index patch = plc.triangles[t].patch;
    const auto& [least, most, comes_nearer] = walls[sides.find(patch)];
    triangles[t] = base.at_triangle(t);
    if (!comes_nearer || plc.patches[patch].planar) continue;
    triangles[t] = most > as_near * least ? std::min(triangles[t], least) : shares[patch] * triangles[t];
  }
  nearer_ = SurfaceTolerance(plc, std::move(triangles), base.largest());
}

const SurfaceTolerance& MeshMaker::tolerance(const Plc& plc) {
  if (!tolerance_) tolerance_ = tolerance(plc, static_cast<int>(job_.given.order));
  return *tolerance_;
}

SurfaceTolerance MeshMaker::tolerance(const Plc& plc, int order) const {
  std::optional<SurfaceTolerance> found;
  ThreadLimit(job_.given.mesh.threads).run([&] {
    found = tolerance_of(plc, job_.given.mesh.bounds, job_.given.mesh.size, order);
  });
  return *found;
}

}  // namespace collarmesh::pipeline
