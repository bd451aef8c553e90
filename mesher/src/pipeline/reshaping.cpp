#include "pipeline/reshaping.h"

#include <algorithm>

#include "coarsen/coarsen_edited.h"
#include "common/thread_limit.h"
#include "improve/improve_edited.h"
#include "pipeline/periodic_faces.h"
#include "pipeline/refinement.h"
#include "remesh/cell_bounds.h"

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

void improve_elements(MeshJob& job, remeshing::EditableMesh& edited, bool thoroughly = true) {
  if (job.options.improve == 0) return;
  if (job.made.coarsening) job.control.begin("improve", 0.7, 0.8);
  const ImproveOptions options = options_of_improvement(job);
  job.made.improvement = improve(edited, options, job.execution(), thoroughly);
  if (job.made.improvement.cancelled) job.control.stop();
}

void coarsen_elements(MeshJob& job, remeshing::EditableMesh& edited) {
  if (!job.options.coarsen) return;
  job.made.coarsening = coarsen(edited, job.refined_with, job.execution());
  if (job.made.coarsening->cancelled) job.control.stop();
  if (!job.options.trace || job.options.improve == 0) return;
  TetMesh coarsened = edited.complex.stored();
  remeshing::mark_cells(coarsened, *job.plc, job.refined_with.bounds);
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
  remeshing::EditableMesh edited(job.made.result.mesh, *job.plc, bounds, 0, job.neighbours);
  job.neighbours = KnownNeighbours();
  job.made.interior_nodes.emplace();
  remeshing::improvement::insert_interior_nodes(edited, bounds, *job.made.interior_nodes);
  edited.store();
}

void complete_interior_nodes(MeshJob& job, remeshing::EditableMesh& edited) {
  if (job.refined_with.bounds.interior_node)
    remeshing::improvement::complete_interior_nodes(edited, job.refined_with.bounds,
                                                    *job.made.interior_nodes);
}

/// Improves tets that miss or nearly miss their bounds, with operations that insert and remove vertices.
void insert_where_poor(MeshJob& job, remeshing::EditableMesh& edited) {
  constexpr double nearly = 1.25;
  if (job.options.improve == 0) return;
  ImproveOptions options = options_of_improvement(job);
  options.keep_vertices = false;
  options.min_dihedral = std::min(options.min_dihedral, nearly * options.bounds.thin_angle);
  if (improve(edited, options, job.execution()).cancelled) job.control.stop();
}

}  // namespace

// Builds one EditableMesh for both coarsening and improvement.
void reshape(MeshJob& job, const std::vector<Index>& fixed) {
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
    const Bounds& bounds = job.refined_with.bounds;
    remeshing::EditableMesh edited(mesh, *job.plc, bounds,
                                   job.options.coarsen ? job.refined_with.edges_per_hole : 0, job.neighbours);
    edited.fix(fixed);
    job.neighbours = KnownNeighbours();
    coarsen_elements(job, edited);
    improve_elements(job, edited, !is_settled_later(job));
    complete_interior_nodes(job, edited);
    if (job.options.coarsen)
      edited.store_marked(bounds);
    else
      edited.store();
  });
  job.trace(job.options.improve > 0 ? "improve" : "coarsen", mesh);
}

void improve_before_coarsening(MeshJob& job, TetMesh& mesh) {
  ThreadLimit(job.options.mesh.threads).run([&] {
    const Bounds& bounds = job.refined_with.bounds;
    remeshing::EditableMesh edited(mesh, *job.plc, bounds, 0);
    improve_elements(job, edited, false);
    edited.store_marked(bounds);
  });
}

void coarsen_and_improve(MeshJob& job, TetMesh& mesh, const std::vector<Index>& fixed, bool thoroughly) {
  ThreadLimit(job.options.mesh.threads).run([&] {
    const Bounds& bounds = job.refined_with.bounds;
    remeshing::EditableMesh edited(mesh, *job.plc, bounds, job.refined_with.edges_per_hole);
    edited.fix(fixed);
    const CoarsenReport coarsening = coarsen(edited, job.refined_with, job.execution());
    if (coarsening.cancelled) job.control.stop();
    if (!job.made.coarsening) job.made.coarsening = coarsening;
    improve_elements(job, edited, thoroughly);
    edited.store_marked(bounds);
  });
}

void reshape(MeshJob& job, remeshing::EditableMesh& edited, const MeshOptions& options, bool insert) {
  if (coarsen(edited, options, job.execution()).cancelled) job.control.stop();
  improve_elements(job, edited);
  if (insert) insert_where_poor(job, edited);
  complete_interior_nodes(job, edited);
}

}  // namespace collarmesh::pipeline
