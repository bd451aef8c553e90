#include "pipeline/reshaping.h"

#include <algorithm>

#include "coarsen/coarsen_workpiece.h"
#include "common/thread_limit.h"
#include "improve/cell_bounds.h"
#include "improve/improve_workpiece.h"
#include "improve/interior_nodes.h"
#include "pipeline/periodic_faces.h"
#include "pipeline/refinement.h"

namespace collarmesh::pipeline {

namespace {

// Reserve of the smallest dihedral angle, relative, if vertices will move onto exact geometry.
constexpr double dihedral_reserve = 0.02;

ImproveOptions options_of_improvement(const MeshJob& job) {
  ImproveOptions options = improve_options(job.options.improve);
  options.bounds = job.refined_with.bounds;
  options.bounds.thin_angle = job.bounds().thin_angle;
  options.threads = job.options.mesh.threads;
  if (job.made.coarsening) {
    options.thin_above = least_thin_ratio(job);
    options.keep_vertices = job.start != Start::constrained;
  }
  if (job.options.min_dihedral > 0) options.min_dihedral = job.options.min_dihedral;
  if (job.exact()) options.min_dihedral *= 1 + dihedral_reserve;
  return options;
}

void improve_elements(MeshJob& job, improvement::Workpiece& workpiece, bool thoroughly = true) {
  if (job.options.improve == 0) return;
  if (job.made.coarsening) job.control.begin("improve", 0.7, 0.8);
  const ImproveOptions options = options_of_improvement(job);
  job.made.improvement = improve(workpiece, options, job.execution(), thoroughly);
  if (job.made.improvement.cancelled) job.control.stop();
}

void coarsen_elements(MeshJob& job, improvement::Workpiece& workpiece) {
  if (!job.options.coarsen) return;
  job.made.coarsening = coarsen(workpiece, job.refined_with, job.execution());
  if (job.made.coarsening->cancelled) job.control.stop();
  if (!job.options.trace || job.options.improve == 0) return;
  TetMesh coarsened = workpiece.complex.stored();
  improvement::mark_cells(coarsened, *job.plc, job.refined_with.bounds);
  job.trace("coarsen", coarsened);
}

/// Returns whether `settle` follows, which first tries faster means than thorough improvement.
bool is_settled_later(const MeshJob& job) {
  return job.start == Start::constrained && !job.refined_with.bounds.interior_node;
}

/// Inserts interior nodes; coarsening removes those that are not needed.
void insert_interior_nodes(MeshJob& job) {
  const Bounds& bounds = job.refined_with.bounds;
  if (!bounds.interior_node) return;
  improvement::Workpiece workpiece(job.made.result.mesh, *job.plc, *bounds.tolerance, 0,
                                   bounds.lower_where_forced, job.neighbours);
  job.neighbours = KnownNeighbours();
  job.made.interior_nodes.emplace();
  improvement::insert_interior_nodes(workpiece, bounds, *job.made.interior_nodes);
  workpiece.complex.store();
}

void complete_interior_nodes(MeshJob& job, improvement::Workpiece& workpiece) {
  if (job.refined_with.bounds.interior_node)
    improvement::complete_interior_nodes(workpiece, job.refined_with.bounds, *job.made.interior_nodes);
}

/// Improves tets that miss their bounds, or nearly so, with operations that insert and remove vertices.
void insert_where_poor(MeshJob& job, improvement::Workpiece& workpiece) {
  constexpr double nearly = 1.25;
  if (job.options.improve == 0) return;
  ImproveOptions options = options_of_improvement(job);
  options.keep_vertices = false;
  options.min_dihedral = std::min(options.min_dihedral, nearly * options.bounds.thin_angle);
  if (improve(workpiece, options, job.execution()).cancelled) job.control.stop();
}

}  // namespace

// Uses one data structure for coarsening and improvement.
void reshape(MeshJob& job) {
  if ((!job.options.coarsen && job.options.improve == 0) || job.made.result.status != MeshStatus::complete) {
    job.neighbours = KnownNeighbours();
    return;
  }
  if (job.options.coarsen)
    job.control.begin("coarsen", 0.6, 0.7);
  else
    job.control.begin("improve", 0.7, 0.8);
  TetMesh& mesh = job.made.result.mesh;
  insert_interior_nodes(job);
  if (job.given.periodic.any()) job.refined = mesh;
  if (begins_with_refined(job)) {
    job.neighbours = KnownNeighbours();
    return;
  }
  ThreadLimit(job.options.mesh.threads).run([&] {
    improvement::Workpiece workpiece(mesh, *job.plc, *job.refined_with.bounds.tolerance,
                                     job.options.coarsen ? job.refined_with.edges_per_hole : 0,
                                     job.refined_with.bounds.lower_where_forced, job.neighbours);
    job.neighbours = KnownNeighbours();
    coarsen_elements(job, workpiece);
    improve_elements(job, workpiece, !is_settled_later(job));
    complete_interior_nodes(job, workpiece);
    workpiece.complex.store();
    if (job.options.coarsen) improvement::mark_cells(mesh, *job.plc, job.refined_with.bounds);
  });
  job.trace(job.options.improve > 0 ? "improve" : "coarsen", mesh);
}

void improve_before_coarsening(MeshJob& job, TetMesh& mesh) {
  ThreadLimit(job.options.mesh.threads).run([&] {
    const Bounds& bounds = job.refined_with.bounds;
    improvement::Workpiece workpiece(mesh, *job.plc, *bounds.tolerance, 0, bounds.lower_where_forced);
    improve_elements(job, workpiece);
    workpiece.complex.store();
    improvement::mark_cells(mesh, *job.plc, bounds);
  });
}

void coarsen_and_improve(MeshJob& job, TetMesh& mesh, const std::vector<Index>& fixed, bool thoroughly) {
  ThreadLimit(job.options.mesh.threads).run([&] {
    const Bounds& bounds = job.refined_with.bounds;
    improvement::Workpiece workpiece(mesh, *job.plc, *bounds.tolerance, job.refined_with.edges_per_hole,
                                     bounds.lower_where_forced);
    workpiece.fix(fixed);
    const CoarsenReport coarsening = coarsen(workpiece, job.refined_with, job.execution());
    if (coarsening.cancelled) job.control.stop();
    if (!job.made.coarsening) job.made.coarsening = coarsening;
    improve_elements(job, workpiece, thoroughly);
    workpiece.complex.store();
    improvement::mark_cells(mesh, *job.plc, bounds);
  });
}

void reshape(MeshJob& job, improvement::Workpiece& workpiece, const MeshOptions& options, bool insert) {
  if (coarsen(workpiece, options, job.execution()).cancelled) job.control.stop();
  improve_elements(job, workpiece);
  if (insert) insert_where_poor(job, workpiece);
  complete_interior_nodes(job, workpiece);
}

}  // namespace collarmesh::pipeline
