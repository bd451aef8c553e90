#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>

namespace collarmesh {

/// The progress of a long operation. `fraction` never decreases within one operation.
struct ProgressReport {
  std::string_view phase;    ///< the stage, such as "read", "complex", "refine", "coarsen", "improve",
                             ///< "project", "second order", "check" or "write"
  double fraction = 0;       ///< share of the whole operation that is done, 0 to 1; an estimate
  std::size_t vertices = 0;  ///< mesh vertices so far
  std::size_t tets = 0;      ///< cells so far
  bool begins = false;       ///< a stage of a whole run begins (`run_pipeline`)
};

/// The caller's means to watch and stop a long operation. Both members may be empty.
struct Execution {
  /// Called several times a second from the working thread; returning false cancels.
  std::function<bool(const ProgressReport&)> progress;
  /// Set it to true from anywhere, even from a signal handler, to cancel.
  const std::atomic<bool>* cancel = nullptr;

  bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace collarmesh
