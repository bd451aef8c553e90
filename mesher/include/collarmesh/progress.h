#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>

namespace collarmesh {

/// Where a long operation stands. `fraction` never decreases within one operation.
struct ProgressReport {
  std::string_view phase;  ///< "read", "complex", "refine", "coarsen", "improve", "project", "second order",
                           ///< "check", "write"
  double fraction = 0;     ///< of the whole operation, 0 to 1; an estimate
  std::size_t vertices = 0;  ///< mesh vertices so far
  std::size_t tets = 0;      ///< cells so far
  bool begins = false;       ///< a stage of a whole run begins (`run_pipeline`)
};

/// How the caller watches and stops a long operation. Both members may be empty.
struct Execution {
  /// Called some times a second from the working thread; returning false cancels.
  std::function<bool(const ProgressReport&)> progress;
  /// Set to true from anywhere (also a signal handler) to cancel.
  const std::atomic<bool>* cancel = nullptr;

  bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace collarmesh
