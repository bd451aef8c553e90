#include "pipeline/division.h"

#include "check/split.h"
#include "collarmesh/partition.h"

namespace collarmesh::pipeline {

void divide(MeshJob& job) {
  if (job.given.partitions == 0) return;
  job.control.begin("partition", 0.96, 1);
  partition(job.made.result.mesh, job.given.partitions);
  job.control.stop_if_asked();
}

void split_patches(MeshJob& job) {
  if (!job.given.split.any()) return;
  job.control.begin("split", 0.98, 1);
  TetMesh& mesh = job.made.result.mesh;
  const checks::SplitMeasures before = checks::measure_before_split(mesh);
  if (job.exact()) mesh.group_names = GroupNames::cad;  // so that the sides get such names
  job.made.split = split(mesh, job.options.split);
  checks::check_split(mesh, job.made.split->interfaces.sides, before, job.made.check);
  job.control.stop_if_asked();
}

}  // namespace collarmesh::pipeline
