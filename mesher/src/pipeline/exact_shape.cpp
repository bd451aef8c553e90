#include "pipeline/exact_shape.h"

namespace collarmesh::pipeline {

void project(MeshJob& job) {
  if (!job.exact() || job.made.result.status != MeshStatus::complete) return;
  job.control.begin("project", 0.8, 0.83);
  const ProjectOptions options{.bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.projection =
      project_boundary(job.made.result.mesh, *job.plc, job.options.exact, options, job.execution());
  job.trace("project", job.made.result.mesh);
}

void raise_order(MeshJob& job) {
  if (job.options.order == 1) return;
  job.control.begin("second order", 0.83, 0.86);
  const SecondOrderOptions options{
      .exact = job.options.exact, .bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.second_order = make_second_order(job.made.result.mesh, *job.plc, options, job.execution());
  if (job.made.second_order.cancelled) job.control.stop();
}

}  // namespace collarmesh::pipeline
