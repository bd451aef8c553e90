#include "pipeline/mesh_job.h"

#include <string>

#include "common/traced_mesh.h"

namespace collarmesh::pipeline {

Bounds MeshJob::bounds() const {
  Bounds bounds = options.mesh.bounds;
  bounds.lower_where_forced = made.result.has_narrow_cells;
  if (!made.coarsening) bounds.thin_angle = 0;
  return bounds;
}

void MeshJob::trace(std::string_view stage, const TetMesh& mesh) {
  if (options.trace) made.trace.push_back(traced_mesh(mesh, std::string(stage)));
}

}  // namespace collarmesh::pipeline
