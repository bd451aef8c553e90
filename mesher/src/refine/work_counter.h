#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// A counter of the cost of insertions, on request (MeshOptions::count_work): the cells that one insertion
/// destroys, the ratio of cells to vertices during refinement, and the insertions for other purposes while a
/// skinny cell waited.
///
/// State: the extremes so far. The loop reports insertions and rounds of blocks.
class WorkCounter {
 public:
  /// Keeps both by reference.
  WorkCounter(const Plc& plc, const RefinedMesh& mesh);

  /// Reports a new vertex. `too_early`: it was inserted for another purpose while a skinny cell waited.
  void note_insertion(const ConflictZone& zone, bool too_early);
  /// Reports a round of blocks, which adds many cells and vertices at once.
  void note_round(const LargestZone& largest);

  void fill(WorkCounts& counts) const;

 private:
  bool at_hub(const ConflictZone& zone) const;
  void note_size();

  const RefinedMesh& mesh_;
  std::vector<bool> vertex_is_hub_, curve_is_hub_;
  LargestZone largest_;
  std::size_t largest_cavity_outside_hubs_ = 0, before_quality_ = 0;
  double peak_cells_per_vertex_ = 0;
};

}  // namespace collarmesh
