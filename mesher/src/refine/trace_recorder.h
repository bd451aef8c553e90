#pragma once

#include <string>

#include "collarmesh/trace.h"
#include "refine/extract.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// A recorder of the state of the refinement each time the number of vertices has doubled, up to a bound. All
/// steps together take no more than a few times the memory of the largest one.
class TraceRecorder {
 public:
  explicit TraceRecorder(const Refined& parts) : parts_(parts) {}

  /// Returns whether the mesh has grown enough for another step.
  bool is_due() const { return parts_.mesh.vertex_count() >= next_ && next_ <= most_vertices; }
  /// Records a step. Precondition: no insertion is in progress. `working_on`: the kind of work done last.
  void record(const std::string& stage, WorkQueue::Priority working_on = WorkQueue::priority_count);
  const Trace& trace() const { return trace_; }

 private:
  static constexpr Index most_vertices = 1 << 17;

  void add_cells(TraceStep& step) const;
  void add_patches(TraceStep& step) const;
  void add_collar_surface(TraceStep& step) const;
  void add_segments(TraceStep& step) const;
  void add_balls(TraceStep& step) const;

  const Refined parts_;
  Index next_ = 16;
  Trace trace_;
};

/// Returns the step after the refinement: the final mesh, with the collars' balls of the step before.
TraceStep stitched_step(const TetMesh& mesh, const TraceStep& before);

}  // namespace collarmesh
