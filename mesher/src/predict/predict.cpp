#include "collarmesh/predict.h"

#include <algorithm>

#include "collarmesh/error.h"
#include "predict/vertex_counts.h"

namespace collarmesh {

namespace {

constexpr double seconds_per_tet = 2e-4;

}  // namespace

Prediction predict(const Plc& plc, const PipelineOptions& options) {
  if (!options.coarsen) throw OptionError("only meshes that are coarsened can be predicted");
  if (options.mesh.size < 0) throw OptionError("size must not be negative; 0 stands for the default");
  require_known_tags(options.mesh, plc);
  MeshOptions mesh = options.mesh;
  mesh.distance = distance_of(options, plc.bounds.diagonal());
  Prediction prediction;
  prediction.size = mesh.size > 0 ? mesh.size : plc.bounds.diagonal() / 20;
  if (plc.regions.size() < 2) return prediction;
  const prediction::VertexCounts counts = prediction::count_vertices(plc, mesh, {});
  prediction.tets = std::max(1.0, counts.tets);
  prediction.seconds = seconds_per_tet * prediction.tets;
  return prediction;
}

}  // namespace collarmesh
