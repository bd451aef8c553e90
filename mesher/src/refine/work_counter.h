#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "refine/refined_mesh.h"

namespace collarmesh {

/// Counts what insertions cost, for those who ask (MeshOptions::count_work): how many cells one of them
/// destroys, how large the mesh is meanwhile, and which come while quality has not been restored.
///
/// State: the extremes so far. The loop tells of insertions and rounds of blocks.
class WorkCounter {
 public:
  /// Both are kept by reference.
  WorkCounter(const Plc& plc, const RefinedMesh& mesh);

  /// A vertex has come. `too_early`: for the sake of something else, while a skinny cell waited.
  void note_insertion(const ConflictZone& zone, bool too_early);
  /// Cells and vertices are many more at once.
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
