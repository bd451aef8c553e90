#include <algorithm>
#include <optional>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "collarmesh/options.h"
#include "refine/features_inside.h"
#include "refine/generate_linked.h"
#include "refine/refinement.h"
#include "refine/trace_recorder.h"

namespace collarmesh {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw OptionError(message);
}

void require_valid(const MeshOptions& o) {
  RunOptions options;
  options.mesh = o;
  options.coarsen = false;  // it validates its own options
  validate(options);
  require(o.edges_per_hole >= 0, "edges per hole must not be negative; 0 switches them off");
  require(o.exterior_radius_edge >= 1, "the exterior radius-edge bound must be at least 1");
  require(o.representation_angle > 0 && o.representation_angle < 90,
          "the representation angle must be between 0 and 90 degrees");
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
                    KnownNeighbours& neighbours, Trace* trace) {
  require_valid(options);
  const FeaturesInside inside(plc);
  MeshOptions of_inside = with_profile(options);
  of_inside.bounds.tolerance = inside.tolerance(tolerance_of(plc, options.bounds, options.size));
  std::optional<Refinement> refinement(std::in_place, inside.plc(), of_inside, execution);
  if (trace != nullptr) refinement->record_steps();
  MeshResult result;
  result.status = refinement->run();
  if (refinement->narrow_cells_are_dear()) {
    of_inside.narrow_cells = NarrowCells::left;
    refinement.emplace(inside.plc(), of_inside, execution);
    if (trace != nullptr) refinement->record_steps();
    result.status = refinement->run();
  }
  result.has_narrow_cells = of_inside.narrow_cells == NarrowCells::left;
  result.statistics = refinement->statistics();
  result.message = refinement->message();
  if (trace != nullptr) *trace = refinement->trace();
  if (!result.message.empty()) result.where = refinement->where();
  if (result.status == MeshStatus::complete || result.status == MeshStatus::guarantee_missed) {
    Extracted extracted = refinement->extract();
    result.mesh = std::move(extracted.mesh);
    neighbours = std::move(extracted.neighbours);
    inside.restore_numbers(result.mesh);
    if (trace != nullptr) trace->push_back(stitched_step(result.mesh, trace->back()));
  }
  return result;
}

}  // namespace collarmesh
