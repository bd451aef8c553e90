#include "pipeline/refinement.h"

#include <algorithm>

#include "pipeline/explosion.h"
#include "refine/generate_linked.h"

namespace collarmesh::pipeline {

namespace {

// Factors and reserve for runs with exact geometry: the bounds must still hold after the vertices have moved
// onto it. The factor on the distance leaves room for twice the triangles' share of it and some more.
constexpr double distance_left = 0.75, ratio_left = 0.99, angle_reserve = 0.05;

// Layers are pushed into the tets, which makes angles worse where walls are one tet apart.
constexpr double reserve_for_layers = 0.2;

// Bound on angles in collars with which refinement ended on all shapes tried. Coarsening and improvement
// reach smaller bounds.
constexpr double reached_collar_angle = 130;

}  // namespace

MeshOptions options_of_refinement(const MeshJob& job, NarrowCells narrow_cells) {
  MeshOptions options = job.options.mesh;
  options.time_limit = 0;  // the control has one limit for all stages
  if (job.options.coarsen) options.narrow_cells = narrow_cells;
  if (job.given.layers.any()) options.bounds.reserve = reserve_for_layers;
  if (!job.exact()) return options;
  options.bounds.tolerance = tolerance_of(*job.plc, options.bounds, 0).scaled(distance_left);
  if (options.profile == Profile::standard)  // the paper's proofs need the given ratio
    options.bounds.radius_edge = std::max(1.0, ratio_left * options.bounds.radius_edge);
  options.bounds.reserve = std::max(angle_reserve, options.bounds.reserve);
  return options;
}

double least_thin_ratio(const MeshJob& job) {
  return job.options.mesh.bounds.radius_edge / (job.exact() ? ratio_left : 1);
}

void refine(MeshJob& job) {
  job.control.begin("refine", 0.06, job.options.coarsen ? 0.6 : 0.7);
  MeshOptions options = job.refined_with;
  options.bounds.interior_node = false;  // a later stage inserts these nodes
  if (job.options.coarsen)
    options.bounds.collar_angle = std::max(options.bounds.collar_angle, reached_collar_angle);
  MeshResult& result = job.made.result = generate(*job.plc, options, job.execution(), job.neighbours,
                                                  job.options.trace ? &job.made.trace : nullptr);
  if (result.status == MeshStatus::cancelled && job.control.out_of_time()) job.control.stop();
  if (job.hit_bound())
    result.message = describe_explosion(*job.plc, job.budget.most(), result.where) +
                     "; mend what nearly meets there, raise the repair tolerance (repair-tolerance), wrap "
                     "it (repair wrap), or let it go on (max-vertices)";
  if (result.status == MeshStatus::cancelled || result.status == MeshStatus::budget_hit) throw Ended();
  job.refined_with.bounds.lower_where_forced = result.has_narrow_cells;
}

}  // namespace collarmesh::pipeline
