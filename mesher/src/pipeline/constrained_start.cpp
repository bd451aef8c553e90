#include "pipeline/constrained_start.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "adapt/bring_to_size.h"
#include "constrained/constrained_tetrahedra.h"
#include "pipeline/certification.h"
#include "pipeline/reshaping.h"
#include "remesh/cell_bounds.h"
#include "remesh/thin_shape.h"

namespace collarmesh::pipeline {

namespace {

/// Returns whether a thin tet or one of a collar has a larger angle than these may have.
bool has_flat_tet(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_thin[t] == 0 && mesh.tet_collar[t] == 0) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    const remeshing::Corners p{mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
    if (remeshing::extreme_angles(p).largest > remeshing::ThinShape::largest_angle) return true;
  }
  return false;
}

}  // namespace

bool may_start_constrained(const PipelineOptions& options) {
  return options.start == Start::automatic && options.coarsen && !options.periodic.any();
}

void tetrahedralize(MeshJob& job) {
  job.control.begin("tetrahedralize", 0.06, 0.2);
  MeshResult& result = job.made.result;
  job.neighbours = KnownNeighbours();
  job.control.watch(
      [&](const Execution& watched) { result.mesh = constrained_tetrahedra(*job.plc, watched).mesh; });
  job.control.begin("remesh", 0.2, 0.6);
  result.has_narrow_cells = job.refined_with.bounds.lower_where_forced = true;
  bool brought = false;
  job.control.watch([&](const Execution& watched) {
    brought = remeshing::adapting::bring_to_size(result.mesh, *job.plc, job.refined_with, watched);
  });
  if (brought) return;
  result.status = MeshStatus::budget_hit;
  result.message =
      fmt::format("{} vertices were reached; raise max-vertices, or the sizes for a coarser mesh",
                  job.refined_with.max_vertices);
  throw Ended();
}

void settle(MeshJob& job, Hope hope) {
  constexpr unsigned most_rounds = 6;
  constexpr std::size_t tets_per_poor = 50, few = 20;
  if (job.refined_with.bounds.interior_node)
    return;  // interior nodes are complete; coarsening would remove
             // them
  PipelineResult& made = job.made;
  std::size_t least = count_misshapen(job, made.result.mesh);
  if (hope == Hope::good && tets_per_poor * least > made.result.mesh.tets.size()) throw Hopeless();
  if (least == 0 && hope == Hope::any) {  // there are still means of improvement to try
    TetMesh mesh = made.result.mesh;
    coarsen_and_improve(job, mesh, {}, true);
    if (count_misshapen(job, mesh) == 0) made.result.mesh = std::move(mesh);
    return;
  }
  // Vertices that face each other fix more tets in less time than detours do.
  bool thoroughly = false;
  for (unsigned round = 0; round < most_rounds && least > 0; ++round) {
    TetMesh mesh = made.result.mesh;
    const auto before = made.improvement;
    job.control.watch([&](const Execution& watched) {
      remeshing::adapting::relax(mesh, *job.plc, job.refined_with, watched);
    });
    coarsen_and_improve(job, mesh, {}, thoroughly);
    const std::size_t poor = count_misshapen(job, mesh);
    if (poor >= least) {
      made.improvement = before;
      if (thoroughly || (hope == Hope::good && least > few)) return;
      thoroughly = true;
      continue;
    }
    const bool goes_on = hope == Hope::any || poor <= few || 4 * poor <= 3 * least;
    least = poor;
    made.result.mesh = std::move(mesh);
    if (!goes_on || (thoroughly && hope == Hope::good)) return;  // another way takes less time
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
