#pragma once

#include "common/deadline.h"
#include "common/stopwatch.h"
#include "refine/domain.h"
#include "refine/outcome.h"

namespace collarmesh {

/// The time, memory and vertices that a refinement may use, and the caller's wish to continue. The loop
/// checks the budget regularly. Only direct callers of `generate` pass a time limit: the pipeline, the
/// program and the Python package watch the time of all stages themselves and cancel.
class Budget {
 public:
  /// The resources in use.
  struct Usage {
    std::size_t vertices, cells, bytes;
    std::size_t planned_vertices;  ///< vertices that will be inserted for sure
    Point last_vertex;             ///< for messages: refinement that does not end stays near it
    double expected_cells;         ///< estimated cells of the complete mesh
  };

  /// Keeps all by reference. Starts the clock.
  Budget(const MeshOptions& options, const Execution& execution, Outcome& outcome)
      : options_(options),
        execution_(execution),
        outcome_(outcome),
        deadline_(Deadline::in(options.time_limit)) {}

  /// Returns whether a budget is spent or the caller has cancelled; if so, sets the outcome.
  bool spent(const Usage& now);

  bool is_out_of_time() const { return deadline_.passed(); }
  /// Returns the seconds since the start.
  double elapsed() const { return stopwatch_.seconds(); }
  std::size_t peak_bytes() const { return peak_bytes_; }

 private:
  bool report_progress(const Usage& now);
  void stop(MeshStatus status, const Usage& now, const std::string& what, const std::string& next);

  const MeshOptions& options_;
  const Execution& execution_;
  Outcome& outcome_;
  Stopwatch stopwatch_;
  Deadline deadline_;
  std::size_t peak_bytes_ = 0;
  double reported_ = -1, fraction_ = 0;  // reported_: seconds at the last progress report; fraction_: the
                                         // largest fraction so far
};

}  // namespace collarmesh
