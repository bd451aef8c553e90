#pragma once

#include <chrono>

namespace collarmesh {

/// A stopwatch that starts when it is made.
class Stopwatch {
 public:
  /// Returns the seconds of the steady clock since the start.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace collarmesh
