#pragma once

#include <cstddef>

#include "collarmesh/progress.h"

namespace collarmesh::repairing {

/// Thrown where repair ends before it is done; caught inside of the library.
struct WorkStopped {
  bool cancelled;  ///< else the work was too much
};

/// How much repair may do. Work is counted, not timed, so that it ends in the same place on every machine: a
/// unit is a pair of triangles near each other that is looked at, some 0.1 microseconds.
class Work {
 public:
  /// Any amount, which nobody watches.
  Work() = default;
  explicit Work(std::size_t most, const Execution& execution) : left_(most), execution_(&execution) {}

  /// Throws WorkStopped.
  void spend(std::size_t units) {
    if (execution_ == nullptr) return;
    if (execution_->cancelled()) throw WorkStopped{true};
    if (units > left_) throw WorkStopped{false};
    left_ -= units;
  }
  std::size_t left() const { return left_; }

 private:
  std::size_t left_ = 0;
  const Execution* execution_ = nullptr;
};

}  // namespace collarmesh::repairing
