#pragma once

#include <cstddef>

#include "collarmesh/progress.h"

namespace collarmesh::repairing {

/// Thrown if repair ends before it is done; caught inside the library.
struct WorkStopped {
  bool cancelled;  ///< false: the work was too much
};

/// Limits the work of repair. Work is counted, not timed, so that it ends in the same place on every machine:
/// a unit is a visited pair of triangles near each other.
class Work {
 public:
  /// Allows any amount of work, without cancellation.
  Work() = default;
  explicit Work(std::size_t most, const Execution& execution) : left_(most), execution_(&execution) {}

  /// Spends units of work. Throws WorkStopped.
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
