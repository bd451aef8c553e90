#pragma once

#include <cstddef>

#include "collarmesh/progress.h"

namespace collarmesh::repairing {

/// Thrown if repair stops early; caught inside the library.
struct WorkStopped {
  bool cancelled;  ///< false: the limit of work was reached
};

/// A limit on the work of repair. Work is counted instead of timed, so that repair stops in the same place on
/// every machine. A unit is one visited pair of near triangles.
class Work {
 public:
  /// Allows any amount of work, without cancellation.
  Work() = default;
  explicit Work(std::size_t most, const Execution& execution) : left_(most), execution_(&execution) {}

  /// Spends units of work. Throws WorkStopped if the limit is reached.
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
