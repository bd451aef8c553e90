#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace collarmesh {

/// A time of the steady clock by which work must end; the type of all time limits. Fits into a lock-free
/// atomic variable, also one in shared memory.
class Deadline {
 public:
  /// Makes a deadline that never passes.
  constexpr Deadline() = default;
  /// Returns the deadline that is this many seconds from now, at most a year; for 0 or less, one that
  /// never passes.
  static Deadline in(double seconds) {
    constexpr double a_year = 3e7;  // the clock's type may not hold much more
    Deadline deadline;
    if (seconds > 0)
      deadline.end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(std::min(seconds, a_year)));
    return deadline;
  }

  bool exists() const { return end_ != never; }
  /// Returns the seconds that remain, negative after the deadline; infinity if it never passes.
  double remaining() const {
    return exists() ? std::chrono::duration<double>(end_ - Clock::now()).count()
                    : std::numeric_limits<double>::infinity();
  }
  /// Returns whether the deadline passed more than `grace` seconds ago.
  bool passed(double grace = 0) const { return remaining() < -grace; }
  /// Returns the seconds that remain as the value of an option: more than 0, or 0 if there is no limit.
  double as_option() const { return exists() ? std::max(remaining(), 1e-3) : 0; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point never = Clock::time_point::max();
  Clock::time_point end_ = never;
};

}  // namespace collarmesh
