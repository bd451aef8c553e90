#include "refine/work_counter.h"

#include <algorithm>

namespace collarmesh {

namespace {

// A hub is a vertex with more curves and patches together, or a curve with more patches, than these numbers.
// The corner that eight boxes share is no hub.
constexpr std::size_t most_at_vertex = 24, most_sheets_at_curve = 8;

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

}  // namespace collarmesh
