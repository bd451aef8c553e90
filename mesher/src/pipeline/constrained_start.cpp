#include "pipeline/constrained_start.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "constrained/constrained_tetrahedra.h"
#include "pipeline/certification.h"
#include "pipeline/reshaping.h"
#include "remesh/bring_to_size.h"

namespace collarmesh::pipeline {

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
    brought = remeshing::bring_to_size(result.mesh, *job.plc, job.refined_with, watched);
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
  constexpr std::size_t tets_per_poor = 50;
  if (job.refined_with.bounds.interior_node)
    return;  // interior nodes are complete; coarsening would remove
             // them
  PipelineResult& made = job.made;
  std::size_t least = count_misshapen(job, made.result.mesh);
  if (hope == Hope::good && tets_per_poor * least > made.result.mesh.tets.size()) throw Hopeless();
  // Vertices that face each other help more tets in less time than detours do.
  bool thoroughly = false;
  for (unsigned round = 0; round < most_rounds && least > 0; ++round) {
    TetMesh mesh = made.result.mesh;
    const auto before = made.improvement;
    job.control.watch(
        [&](const Execution& watched) { remeshing::relax(mesh, *job.plc, job.refined_with, watched); });
    coarsen_and_improve(job, mesh, {}, thoroughly);
    const std::size_t poor = count_misshapen(job, mesh);
    if (poor >= least) {
      made.improvement = before;
      if (thoroughly) return;
      thoroughly = true;
      continue;
    }
    const bool goes_on = hope == Hope::any || !thoroughly || 2 * poor <= least;
    least = poor;
    made.result.mesh = std::move(mesh);
    if (!goes_on) return;  // another way takes less time
  }
}

}  // namespace collarmesh::pipeline
