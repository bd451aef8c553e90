#include "refine/work_counter.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "common/parallel_for.h"

namespace collarmesh {

namespace {

// A hub has more features than these: as many as meet where eight boxes share a corner, or where their sides
// share an edge.
constexpr std::size_t most_at_vertex = 24, most_sheets_at_curve = 8;

/// Replaces a value by a new one if `comes_first` prefers that. Several threads may call it at once.
template <class ComesFirst>
void replace_if(const ComesFirst& comes_first, double& place, double value) {
  const std::atomic_ref<double> shared(place);
  double found = shared.load(std::memory_order_relaxed);
  while (comes_first(value, found) &&
         !shared.compare_exchange_weak(found, value, std::memory_order_relaxed)) {
  }
}

}  // namespace

WorkCounter::WorkCounter(const Plc& plc, const RefinedMesh& mesh) : mesh_(mesh) {
  for (const Plc::Vertex& v : plc.vertices)
    vertex_is_hub_.push_back(v.curves.size() + v.patches.size() > most_at_vertex);
  for (const Plc::Curve& c : plc.curves) curve_is_hub_.push_back(c.patches.size() > most_sheets_at_curve);
}

void WorkCounter::note_insertion(const ConflictZone& zone, bool too_early) {
  largest_.add(zone);
  if (zone.cells.size() > largest_cavity_outside_hubs_ && !at_hub(zone))
    largest_cavity_outside_hubs_ = zone.cells.size();
  if (too_early) ++before_quality_;
  note_size();
}

void WorkCounter::note_round(const LargestZone& largest) {
  largest_.add(largest);
  largest_cavity_outside_hubs_ = std::max(largest_cavity_outside_hubs_, largest.cells);
  note_size();
}

// Returns whether the zone lies at a hub: a vertex there is connected with everything near it.
bool WorkCounter::at_hub(const ConflictZone& zone) const {
  return std::ranges::any_of(zone.vertices, [&](Index v) {
    const Feature& feature = mesh_.feature(v);
    return (feature.dimension == 0 && vertex_is_hub_[feature.index]) ||
           (feature.dimension == 1 && curve_is_hub_[feature.index]);
  });
}

void WorkCounter::note_size() {
  peak_cells_per_vertex_ = std::max(peak_cells_per_vertex_, static_cast<double>(mesh_.cell_count()) /
                                                                static_cast<double>(mesh_.vertex_count()));
}

void WorkCounter::fill(WorkCounts& counts) const {
  counts.largest_degree = largest_.vertices;
  counts.largest_cavity = largest_.cells;
  counts.largest_cavity_outside_hubs = largest_cavity_outside_hubs_;
  counts.peak_cells_per_vertex = peak_cells_per_vertex_;
  counts.before_quality = before_quality_;
}

AspectRatios aspect_ratios(const RefinedMesh& mesh, const std::function<bool(Index cell)>& counts) {
  std::vector<double> squared_radius(mesh.vertex_count(), 0), squared_edge(mesh.vertex_count(), INFINITY);
  const auto see_cell = [&](Index cell) {
    const auto& v = mesh.corners(cell);
    const double radius = counts(cell) ? mesh.squared_radius(cell) : INFINITY;
    for (unsigned i = 0; i < 4; ++i) {
      replace_if(std::greater<double>(), squared_radius[v[i]], radius);
      for (unsigned j = i + 1; j < 4; ++j) {
        const double length = squared_distance(mesh.point(v[i]), mesh.point(v[j]));
        replace_if(std::less<double>(), squared_edge[v[i]], length);
        replace_if(std::less<double>(), squared_edge[v[j]], length);
      }
    }
  };
  parallel_for_each(mesh.cell_capacity(), [&](std::size_t cell) {
    if (mesh.alive(static_cast<Index>(cell))) see_cell(static_cast<Index>(cell));
  });
  AspectRatios ratios;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (squared_radius[v] == INFINITY) continue;
    const double ratio = 2 * std::sqrt(squared_radius[v] / squared_edge[v]);
    ratios.smallest = ratios.smallest == 0 ? ratio : std::min(ratios.smallest, ratio);
    ratios.largest = std::max(ratios.largest, ratio);
  }
  return ratios;
}

}  // namespace collarmesh
