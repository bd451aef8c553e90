#include "pipeline/vertex_budget.h"

#include <algorithm>

#include "pipeline/constrained_start.h"
#include "pipeline/vertex_bound.h"

namespace collarmesh::pipeline {

void VertexBudget::bound(Ways ways) {
  const bool repairs = given_.repair.mode != RepairMode::off && !given_.repair.wrap_at_once;
  ways_ = repairs || may_start_constrained(given_) ? ways : Ways::none;
  is_known_ = is_tight_ = false;
  compared_with_ = 0;
}

void VertexBudget::tighten() {
  is_tight_ = true;
  is_known_ = false;
}

void VertexBudget::compare_with(std::size_t constrained_vertices) {
  compared_with_ = constrained_vertices;
  is_known_ = false;
}

// Uses a limit that the options give unless the computed one is smaller; without further repairs and starts,
// always uses the given one.
void VertexBudget::find(const Plc& plc, const PipelineOptions& options) {
  // The least bounds are high because bodies far thinner than the size really need many vertices.
  constexpr std::size_t times_without_other_ways = 2, least_without_other_ways = 300'000,
                        least_before_constrained = 100'000, times_constrained = 50;
  constexpr std::size_t by_tightening = 4;  // real parts need no more (vertex_bound.cpp)
  if (is_known_) return;
  const std::size_t given = given_.mesh.max_vertices;
  is_known_ = true;
  most_ = 0;
  if (given_.mesh.profile == Profile::paper) return;  // its sizes do not tell how many vertices to expect
  if (ways_ != Ways::others && given > 0) return;
  std::size_t most = most_vertices_expected(plc, options);
  if (ways_ == Ways::others && is_tight_) most /= by_tightening;
  if (ways_ == Ways::constrained)
    most = std::max({most, least_before_constrained, most_vertices_on_rods(plc, options.mesh)});
  if (ways_ == Ways::none)
    most = std::max({times_without_other_ways * most, least_without_other_ways,
                     most_vertices_on_rods(plc, options.mesh)});
  if (compared_with_ > 0)
    most = std::min(most, std::max(least_before_constrained, times_constrained * compared_with_));
  if (given == 0 || given > most) most_ = most;
}

bool VertexBudget::ended_at_vertices(const MeshResult& result, bool out_of_time) const {
  const std::size_t memory = given_.mesh.max_memory;
  return result.status == MeshStatus::budget_hit && !out_of_time &&
         (memory == 0 || result.statistics.peak_bytes <= memory);
}

bool VertexBudget::hit(const MeshResult& result, bool out_of_time) const {
  return most_ > 0 && ended_at_vertices(result, out_of_time);
}

}  // namespace collarmesh::pipeline
