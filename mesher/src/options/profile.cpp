#include <algorithm>

#include "collarmesh/options.h"

namespace collarmesh {

namespace {

constexpr double right_angle = 90;
// The proofs permit any bound above 2 sqrt 2 (paper, section 1.2).
constexpr double proved_radius_edge = 2.83;

}  // namespace

MeshOptions with_profile(MeshOptions options) {
  if (options.profile == Profile::standard) return options;
  Bounds& bounds = options.bounds;
  bounds.crease_angle = right_angle;
  bounds.thin_angle = 0;
  if (!bounds.thin_in_narrow_places_only)  // no ratio was given, so thin tets may be anywhere
    bounds.radius_edge = std::max(bounds.radius_edge, proved_radius_edge);
  options.exterior_radius_edge = bounds.radius_edge;
  options.narrow_cells = NarrowCells::bounded;
  options.collar_creation = CollarCreation::in_pass;
  return options;
}

PipelineOptions with_profile(PipelineOptions options) {
  if (options.mesh.profile == Profile::standard) return options;
  options.mesh = with_profile(options.mesh);
  options.coarsen = false;
  options.improve = 0;
  options.min_dihedral = 0;
  return options;
}

RunOptions with_profile(RunOptions options) {
  static_cast<PipelineOptions&>(options) = with_profile(static_cast<PipelineOptions>(options));
  return options;
}

}  // namespace collarmesh
