#include "pipeline/periodic_faces.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "coarsen/target_sizes.h"
#include "common/thread_limit.h"
#include "improve/improve_edited.h"
#include "periodic/change_across.h"
#include "periodic/make_periodic.h"
#include "periodic/node_map.h"
#include "pipeline/certification.h"
#include "pipeline/reshaping.h"
#include "remesh/cell_bounds.h"

namespace collarmesh::pipeline {

namespace {

using periodicity::Recut;

TetMesh refined_with_nodes_of(MeshJob& job, const TetMesh& source) {
  TetMesh mesh = job.refined;
  std::vector<double> targets;
  if (&source == &job.refined)
    targets = remeshing::coarsening::target_sizes(source, *job.plc, job.refined_with);
  coarsen_and_improve(job, mesh,
                      periodicity::add_periodic_nodes(mesh, source, *job.plc, job.options.periodic,
                                                      job.refined_with.bounds.tolerance->largest(), targets));
  return mesh;
}

bool has_smooth_patches(const Plc& plc) {
  return std::ranges::any_of(plc.patches, [](const Plc::Patch& patch) { return !patch.planar; });
}

template <class Change>
void change_across(MeshJob& job, TetMesh& mesh, Recut::Moved moved, const Change& change) {
  const SurfaceTolerance& tolerance = *job.refined_with.bounds.tolerance;
  ThreadLimit(job.options.mesh.threads).run([&] {
    periodicity::change_across(mesh, *job.plc, job.options.periodic, tolerance.largest(), tolerance, moved,
                               job.refined_with.edges_per_hole, change);
    remeshing::mark_cells(mesh, *job.plc, job.refined_with.bounds);
  });
}

void divide_curves_at_poor_tets(MeshJob& job, TetMesh& mesh) {
  change_across(job, mesh, Recut::Moved::beside_first, [&](remeshing::EditableMesh& edited, const auto&) {
    remeshing::improvement::divide_curves_at_poor_tets(edited, job.refined_with.bounds);
  });
}

/// Coarsens and improves a periodic mesh while it is cut open at up to three places, one after the other,
/// until there are no violations (`count_misshapen`). Inserts vertices if asked to. Keeps the mesh with the
/// fewest violations, and returns their number.
std::size_t reshape_across(MeshJob& job, TetMesh& mesh, bool insert) {
  using Moved = Recut::Moved;
  TetMesh best;
  std::size_t least = SIZE_MAX;
  for (const Moved moved : {Moved::beside_first, Moved::beside_second, Moved::first_half}) {
    change_across(job, mesh, moved, [&](remeshing::EditableMesh& edited, const Recut& recut) {
      MeshOptions options = job.refined_with;
      options.size_field = recut.sizes(options.size_field);
      reshape(job, edited, options, insert);
    });
    const std::size_t poor = count_misshapen(job, mesh);
    if (poor < least) {
      least = poor;
      best = mesh;
    }
    if (least == 0) break;
  }
  mesh = std::move(best);
  return least;
}

}  // namespace

bool begins_with_refined(const MeshJob& job) {
  return job.given.periodic.any() && has_smooth_patches(*job.plc);
}

void make_faces_periodic(MeshJob& job) {
  PipelineResult& made = job.made;
  if (!job.given.periodic.any() || made.result.status != MeshStatus::complete) return;
  constexpr unsigned most_tries = 4, most_rounds = 3;
  job.control.begin("periodic faces", 0.75, 0.79);
  ImproveReport improvement = made.improvement;
  const bool from_refined = begins_with_refined(job);
  TetMesh best, source = std::exchange(made.result.mesh, {});
  if (from_refined) source = {};
  std::size_t least = SIZE_MAX;
  for (unsigned k = 0; k < most_tries && least > 0; ++k) {
    if (from_refined && k == 1) coarsen_and_improve(job, source = job.refined, {});
    TetMesh mesh = refined_with_nodes_of(job, from_refined && k == 0 ? job.refined : source);
    if (from_refined && k == 0) improvement = made.improvement;
    const PeriodicReport report =
        make_periodic(mesh, *job.plc, job.options.periodic, job.refined_with.bounds.tolerance->largest());
    periodicity::map_corners(mesh);
    std::size_t before = SIZE_MAX;
    for (unsigned round = 0; round < most_rounds; ++round) {
      const std::size_t poor = reshape_across(job, mesh, k > 0 || round > 0);
      if (poor < least) {
        least = poor;
        best = mesh;
        made.periodic = report;
      }
      if (poor == 0 || poor >= before || round + 1 == most_rounds) break;
      divide_curves_at_poor_tets(job, mesh);
      if (before == SIZE_MAX && !(from_refined && k == 0)) source = mesh;
      before = poor;
    }
  }
  job.refined = {};
  made.improvement = improvement;
  made.result.mesh = std::move(best);
  job.trace("periodic faces", made.result.mesh);
}

}  // namespace collarmesh::pipeline
