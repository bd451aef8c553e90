#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "refine/features_inside.h"
#include "refine/generate_linked.h"
#include "refine/refinement.h"

namespace collarmesh {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw OptionError(message);
}

void validate(const MeshOptions& o) {
  require(o.size >= 0 && o.size_min >= 0 && o.distance >= 0 && o.gradation >= 0,
          "sizes, distance and gradation must not be negative; 0 stands for the default");
  require(o.elements_per_circle >= 0 && o.elements_across_gap >= 0 && o.edges_per_hole >= 0,
          "elements per circle, across gaps and edges per hole must not be negative; 0 switches them off");
  require(o.size == 0 || o.size_min <= o.size,
          fmt::format("size-min {} exceeds size {}; make it smaller", o.size_min, o.size));
  require(o.radius_edge >= 1 && o.exterior_radius_edge >= 1, "radius-edge must be at least 1");
  require(o.vertex_ratio == 0 || o.vertex_ratio > 2.83,
          "vertex-ratio must exceed 2 sqrt 2 (the proved bound); 0 switches it off");
  require(o.crease_angle >= 0 && o.crease_angle <= 90, "crease-angle must be from 0 to 90 degrees");
  require(o.representation_angle > 0 && o.representation_angle < 90,
          "representation-angle must be between 0 and 90 degrees");
  require(o.time_limit >= 0, "time-limit must not be negative; 0 stands for none");
  require(o.collar_angle >= 100 && o.collar_angle <= 175, "collar-angle must be from 100 to 175 degrees");
  require(o.theta >= 0 && o.theta < 0.45, "theta must be in [0, 0.45)");
  for (const auto* sizes : {&o.region_size, &o.patch_size, &o.curve_size})
    for (const auto& [tag, size] : *sizes)
      require(size > 0, fmt::format("the size of tag {} must be positive", tag));
}

}  // namespace

double default_distance(double size, double diagonal, int order) {
  constexpr double share_of_size = 0.1, sizes_per_diagonal = 20, for_curved_elements = 1.0 / 550;
  const double largest = diagonal / sizes_per_diagonal;
  const double distance = share_of_size * (size > 0 ? std::min(size, largest) : largest);
  return order == 2 ? std::min(distance, for_curved_elements * diagonal) : distance;
}

MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution) {
  KnownNeighbours neighbours;
  return generate(plc, options, execution, neighbours);
}

MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution,
                    KnownNeighbours& neighbours) {
  validate(options);
  const FeaturesInside inside(plc);
  Refinement refinement(inside.plc(), options, execution);
  MeshResult result;
  result.status = refinement.run();
  result.statistics = refinement.statistics();
  result.message = refinement.message();
  if (!result.message.empty()) result.where = refinement.where();
  if (result.status == MeshStatus::complete || result.status == MeshStatus::guarantee_missed) {
    Extracted extracted = refinement.extract();
    result.mesh = std::move(extracted.mesh);
    neighbours = std::move(extracted.neighbours);
    inside.restore_numbers(result.mesh);
  }
  return result;
}

}  // namespace collarmesh
