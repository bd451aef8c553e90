#include "pipeline/constrained_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "adapt/bring_to_size.h"
#include "collarmesh/plc_builder.h"
#include "common/cell_shapes.h"
#include "common/thread_limit.h"
#include "constrained/constrained_tetrahedra.h"
#include "constrained/ladders.h"
#include "constrained/rods.h"
#include "pipeline/certification.h"
#include "pipeline/reshaping.h"
#include "pipeline/vertex_bound.h"
#include "remesh/cell_bounds.h"
#include "remesh/thin_shape.h"
#include "tolerance/thin_shells.h"

namespace collarmesh::pipeline {

namespace {

// If more than one in this many tets misses its bounds, a mesh is not worth further work.
constexpr std::size_t tets_per_poor = 50;

/// Returns whether a thin tet, or a tet in a collar, has a larger angle than thin tets may have.
bool has_flat_tet(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_thin[t] == 0 && mesh.tet_collar[t] == 0) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    const remeshing::Corners p{mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
    if (remeshing::extreme_angles(p).largest > remeshing::ThinShape::largest_angle) return true;
  }
  return false;
}

/// Puts the constrained tetrahedra of a complex into the job. The complex must have the features of the
/// job's.
void fill(MeshJob& job, const Plc& plc) {
  job.control.begin("tetrahedralize", 0.06, 0.2);
  job.control.watch(
      [&](const Execution& watched) { job.made.result.mesh = constrained_tetrahedra(plc, watched).mesh; });
}

/// Returns whether neither the options nor the complex ask for different sizes at different places.
bool has_one_size(const MeshOptions& asked, const Plc& plc) {
  return std::ranges::none_of(plc.regions, [](const Plc::Region& region) { return region.size > 0; }) &&
         asked.region_size.empty() && asked.patch_size.empty() && asked.curve_size.empty() &&
         !asked.size_field && asked.elements_per_circle == 0 && asked.elements_across_gap == 0;
}

/// Returns whether ladders may help. They help in shells far thinner than the size. No faces may be periodic,
/// and one size must be asked for everywhere, because ladders are divided to that size and not further.
bool may_have_ladders(const MeshJob& job, double size) {
  return has_one_size(job.options.mesh, *job.plc) && !job.given.periodic.any() &&
         has_thin_shells(*job.plc, *job.refined_with.bounds.tolerance, size);
}

/// Returns whether a number of vertices exceeds the limit on vertices, if there is one.
bool exceeds_vertices(const MeshJob& job, std::size_t vertices) {
  const std::size_t most = job.refined_with.max_vertices;
  return most > 0 && vertices > most;
}

/// Returns the complex with its long narrow strips divided like ladders, with rungs about a size apart.
Plc divided_strips(const MeshJob& job, double size, const Vector& diagonals) {
  constexpr double share_of_tolerance = 0.05;
  const auto may_move = [&](Index triangle) {
    return share_of_tolerance * job.refined_with.bounds.tolerance->at_triangle(triangle);
  };
  return with_ladders(*job.plc, size, may_move, diagonals);
}

/// Makes, improves and coarsens tetrahedra between the rungs of strips. Returns the number of tets that miss
/// their bounds. If many do before coarsening, gives up and returns the number of all tets.
std::size_t fill_ladders(MeshJob& job, const Plc& divided) {
  constexpr std::size_t tets_per_poor_before = 30;
  fill(job, divided);
  TetMesh& mesh = job.made.result.mesh;
  job.control.begin("remesh", 0.2, 0.6);
  job.made.coarsening.emplace();  // thin tets count as good, as after coarsening
  improve_before_coarsening(job, mesh);
  std::size_t poor = mesh.tets.size();
  if (tets_per_poor_before * count_misshapen(job, mesh) <= mesh.tets.size()) {
    coarsen_and_improve(job, mesh, {}, true);
    poor = count_misshapen(job, mesh);
  }
  job.made.coarsening.reset();
  return poor;
}

/// Throws Hopeless if so many tets miss their bounds before coarsening and improvement that too many will
/// miss them afterwards: more than `times_before` times as many as may miss them then.
void require_few_misshapen(MeshJob& job) {
  constexpr std::size_t times_before = 4;
  TetMesh mesh = job.made.result.mesh;  // a copy, so that later stages get the mesh without marks
  remeshing::mark_cells(mesh, *job.plc, job.refined_with.bounds);
  job.made.coarsening.emplace();  // thin tets count as good, as after coarsening
  const std::size_t misshapen = count_misshapen(job, mesh);
  job.made.coarsening.reset();
  if (tets_per_poor * misshapen > times_before * mesh.tets.size()) throw Hopeless();
}

/// Runs an attempt at a better mesh in at most half of the remaining time, so that as much is left for later
/// stages. Returns whether it came to its end in time; if not, the reports are as before. Throws Ended if the
/// run is cancelled.
bool attempt(MeshJob& job, const std::function<void()>& work) {
  constexpr double share_of_time = 0.5;
  PipelineResult& made = job.made;
  const MeshStatus status = made.result.status;
  const std::string message = made.result.message;
  const auto coarsening = made.coarsening;
  const auto improvement = made.improvement;
  bool ended = false;
  try {
    job.control.attempt(share_of_time, [&] {
      work();
      job.control.stop_if_asked();
      ended = true;
    });
  } catch (const Ended&) {
    if (made.result.status == MeshStatus::cancelled) throw;
    made.result.status = status;
    made.result.message = message;
    made.coarsening = coarsening;
    made.improvement = improvement;
  }
  return ended;
}

/// Divides strips of the complex like ladders, if it has any, and fills it with tetrahedra. Returns whether
/// the mesh is good: hardly any tet misses its bounds or has a far too long edge, and the limit on vertices
/// is kept. In a good mesh, vertices on opposite sides of strips face each other, so no further work is
/// needed: collapses that ignore bounds would do harm. Rounding decides which diagonals of the ladders' cells
/// leave flat tets. So tries diagonals along three directions, and along more if at most five tets of the
/// best mesh so far are poor. Stops at a mesh without poor tets, or when a try is given up before coarsening,
/// has too long edges or exceeds the limit on vertices. A time limit cannot lose the best mesh so far.
bool is_good_with_ladders(MeshJob& job) {
  constexpr std::array<Vector, 7> directions{{{0.36, 0.48, 0.8},
                                              {-0.36, 0.48, 0.8},
                                              {0.36, -0.48, 0.8},
                                              {-0.2, 0.55, 0.81},
                                              {0.55, -0.2, 0.81},
                                              {0.81, 0.2, -0.55},
                                              {0.2, -0.81, 0.55}}};
  constexpr std::size_t always = 3, very_few = 5;
  const double size = smallest_size(job.options.mesh, job.plc->bounds.diagonal());
  if (!may_have_ladders(job, size)) return false;
  MeshResult& result = job.made.result;
  std::optional<TetMesh> best;
  std::size_t least = none;
  bool goes_on = true;
  const auto try_with = [&](const Plc& divided) {
    const std::size_t poor = fill_ladders(job, divided);
    TetMesh& mesh = result.mesh;
    goes_on =
        poor < mesh.tets.size() && keeps_lengths(mesh, size) && !exceeds_vertices(job, mesh.points.size());
    if (!goes_on || poor >= least || tets_per_poor * poor > mesh.tets.size()) return;
    goes_on = poor > 0;
    least = poor;
    best = std::move(mesh);
  };
  for (std::size_t i = 0; i < directions.size() && goes_on && (i < always || least <= very_few); ++i) {
    const Plc divided = divided_strips(job, size, directions[i]);
    if (divided.points.size() == job.plc->points.size() || exceeds_vertices(job, divided.points.size()))
      return false;
    try {
      if (!best)
        try_with(divided);
      else if (!attempt(job, [&] { try_with(divided); }))
        break;
    } catch (const PlcError&) {
      // points of these ladders cannot be separated
    }
  }
  job.made.coarsening.reset();
  if (!best) return false;
  result.mesh = std::move(*best);
  return true;
}

}  // namespace

bool keeps_lengths(const TetMesh& mesh, double size) {
  constexpr double longest = 2.5, tets_per_long = 100;
  const auto is_long = [&](const std::array<Index, 4>& tet) {
    return std::ranges::any_of(cell_shapes::corner_pairs, [&](const auto& edge) {
      return distance(mesh.points[tet[edge[0]]], mesh.points[tet[edge[1]]]) > longest * size;
    });
  };
  return tets_per_long * static_cast<double>(std::ranges::count_if(mesh.tets, is_long)) <=
         static_cast<double>(mesh.tets.size());
}

bool may_have_rods(const MeshJob& job) {
  const MeshOptions& asked = job.options.mesh;
  const Bounds &given = job.given.mesh.bounds, &bounds = asked.bounds;
  const bool asks_for_shapes = job.given.min_dihedral > 0 || bounds.interior_node ||
                               bounds.thin_in_narrow_places_only ||
                               asked.edges_per_hole > MeshOptions{}.edges_per_hole;
  return may_start_constrained(job.given) && has_one_size(asked, *job.plc) && !asks_for_shapes &&
         !(given.distance > 0) && !given.tolerance && asked.profile == Profile::standard &&
         !job.given.layers.any();
}

bool fill_rods(MeshJob& job) {
  MeshResult& result = job.made.result;
  std::optional<TetMesh> mesh;
  ThreadLimit(job.options.mesh.threads).run([&] {
    const RodLimits limits{.size = smallest_size(job.options.mesh, job.plc->bounds.diagonal()),
                           .most_vertices = job.refined_with.max_vertices};
    mesh = tetrahedra_of_rods(*job.plc, *job.options.mesh.bounds.tolerance, limits, job.execution());
  });
  job.control.stop_if_asked();
  if (!mesh) return false;
  result.mesh = std::move(*mesh);
  CoarsenReport& coarsening = job.made.coarsening.emplace();  // tets may be thin, as after coarsening
  coarsening.tets_before = coarsening.tets_after = result.mesh.tets.size();
  remeshing::mark_cells(result.mesh, *job.plc, job.refined_with.bounds);
  if (count_misshapen(job, result.mesh) > 0) return false;
  job.control.begin("tetrahedralize", 0.06, 0.2);
  job.trace("tetrahedralize", result.mesh);
  return true;
}

bool may_start_constrained(const PipelineOptions& options) {
  return options.start == Start::automatic && options.coarsen && !options.periodic.any();
}

void tetrahedralize(MeshJob& job, Hope hope) {
  MeshResult& result = job.made.result;
  job.neighbours = KnownNeighbours();
  result.has_narrow_cells = job.refined_with.bounds.lower_where_forced = true;
  // Meshes with ladders do not depend on the seed, so they are tried only with the first seed.
  if (job.refined_with.seed == job.given.mesh.seed && is_good_with_ladders(job)) return;
  fill(job, *job.plc);
  job.control.begin("remesh", 0.2, 0.6);
  bool brought = false;
  job.control.watch([&](const Execution& watched) {
    brought = remeshing::adapting::bring_to_size(result.mesh, *job.plc, job.refined_with, watched);
  });
  if (brought) {
    if (hope == Hope::good) require_few_misshapen(job);
    return;
  }
  result.status = MeshStatus::budget_hit;
  result.message =
      fmt::format("the limit of {} vertices is reached; raise max-vertices, or the sizes for a coarser mesh",
                  job.refined_with.max_vertices);
  throw Ended();
}

void settle(MeshJob& job, Hope hope) {
  constexpr unsigned most_rounds = 6;
  constexpr std::size_t few = 20, within_reach = 50;
  if (job.refined_with.bounds.interior_node) return;  // coarsening would remove interior nodes
  PipelineResult& made = job.made;
  std::size_t least = count_misshapen(job, made.result.mesh);
  if (hope == Hope::good && tets_per_poor * least > made.result.mesh.tets.size()) throw Hopeless();
  // If no tet is misshapen, coarsen and improve once more, thoroughly. Keep the result if no tet is misshapen
  // then.
  if (least == 0 && hope == Hope::any) {
    TetMesh mesh = made.result.mesh;
    const auto before = made.improvement;
    const bool ended = attempt(job, [&] { coarsen_and_improve(job, mesh, {}, true); });
    if (ended && count_misshapen(job, mesh) == 0)
      made.result.mesh = std::move(mesh);
    else
      made.improvement = before;
    return;
  }
  // If more tets than this are poor, do not turn to thorough improvement, and begin another round only if the
  // last one gained much.
  const std::size_t in_reach = within_reach + made.result.mesh.tets.size() / tets_per_poor;
  // Begin without thorough improvement, which is slow: `relax` divides edges so that vertices face each
  // other, and that mends more tets in less time.
  bool thoroughly = false;
  for (unsigned round = 0; round < most_rounds && least > 0; ++round) {
    TetMesh mesh = made.result.mesh;
    const auto before = made.improvement;
    const bool ended = attempt(job, [&] {
      job.control.watch([&](const Execution& watched) {
        remeshing::adapting::relax(mesh, *job.plc, job.refined_with, watched);
      });
      coarsen_and_improve(job, mesh, {}, thoroughly);
    });
    if (!ended) return;
    const std::size_t poor = count_misshapen(job, mesh);
    if (poor >= least) {
      made.improvement = before;
      if (thoroughly || (hope == Hope::good && least > few) || least > in_reach) return;
      thoroughly = true;
      continue;
    }
    const bool gains_little = poor > few && 10 * poor > 9 * least;
    const bool goes_on = hope == Hope::any ? !gains_little || (poor <= in_reach && !thoroughly)
                                           : poor <= few || 4 * poor <= 3 * least;
    least = poor;
    made.result.mesh = std::move(mesh);
    if (!goes_on || (thoroughly && hope == Hope::good)) return;  // another way takes less time
    thoroughly |= gains_little && hope == Hope::any;
  }
}

void mend_flat_tets(MeshJob& job) {
  const bool inserts = job.options.coarsen && job.options.improve > 0 && !job.given.periodic.any() &&
                       !job.refined_with.bounds.interior_node;
  if (!inserts || job.made.result.status != MeshStatus::complete || !has_flat_tet(job.made.result.mesh))
    return;
  const std::size_t least = count_misshapen(job, job.made.result.mesh);
  if (least == 0) return;
  TetMesh mesh = job.made.result.mesh;
  bool changed = false;
  job.control.watch([&](const Execution& watched) {
    changed = remeshing::adapting::face_each_other(mesh, *job.plc, job.refined_with, watched);
  });
  if (!changed) return;
  remeshing::mark_cells(mesh, *job.plc, job.refined_with.bounds);
  if (count_misshapen(job, mesh) < least) job.made.result.mesh = std::move(mesh);
}

}  // namespace collarmesh::pipeline
