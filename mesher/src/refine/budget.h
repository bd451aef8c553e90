#pragma once

#include <chrono>

#include "refine/domain.h"
#include "refine/outcome.h"

namespace collarmesh {

/// Time, memory and vertices that a refinement may use, and whether the caller wants it to go on.
/// The loop asks now and then. A time limit is for callers of `generate`: the pipeline, the program and the
/// Python package watch the time of all stages themselves, pass none, and cancel.
class Budget {
 public:
  /// What is in use.
  struct Usage {
    std::size_t vertices, cells, bytes;
    std::size_t planned_vertices;  ///< that will come for sure
    Point last_vertex;             ///< a refinement that does not end stays where it is
    double expected_cells;         ///< when it is complete, about
  };

  /// All are kept by reference. The clock starts.
  Budget(const MeshOptions& options, const Execution& execution, Outcome& outcome);

  /// Is something spent, or the caller no longer interested? Then the outcome says so.
  bool spent(const Usage& now);

  bool is_out_of_time() const { return options_.time_limit > 0 && elapsed() > options_.time_limit; }
  /// Seconds since the start.
  double elapsed() const;
  std::size_t peak_bytes() const { return peak_bytes_; }

 private:
  bool report_progress(const Usage& now);
  void stop(MeshStatus status, const Usage& now, const std::string& what, const std::string& next);

  const MeshOptions& options_;
  const Execution& execution_;
  Outcome& outcome_;
  std::chrono::steady_clock::time_point started_;
  std::size_t peak_bytes_ = 0;
  double reported_ = -1, fraction_ = 0;  // progress: seconds at the last report, largest fraction
};

}  // namespace collarmesh
