#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/progress.h"

namespace collarmesh::python {

/// The error of work that ended on request.
struct Cancelled : Error {
  using Error::Error;
};

/// The error of work whose budget of vertices, memory or time is spent.
struct BudgetSpent : Error {
  using Error::Error;
};

/// The data that the working thread shares with its caller. It lives as long as either needs it: an
/// interrupted call may leave work that does not check the flag soon enough.
class Watch {
 public:
  /// Returns the execution for the work. It sends reports to the calling thread, which asks Python whether to
  /// go on.
  Execution execution();
  /// Throws Cancelled if the work must end.
  void stop_if_asked() const;
  const std::atomic<bool>& flag() const { return cancel_; }
  void begin_stage(std::string stage);

 private:
  friend void run_watched(std::function<void(Watch&)> work, const pybind11::object& progress,
                          double time_limit);

  struct News {
    std::string phase;
    double fraction;
  };
  void report(std::string phase, double fraction);

  std::atomic<bool> cancel_{false};
  std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  std::vector<News> news_;  // reports that the caller has not yet taken: the last one of each phase, so that
                            // no phase is missed
  std::string stage_ = "start";
  bool done_ = false;
  std::exception_ptr failure_;
};

/// Does the work in a thread of its own. Meanwhile checks signals, so that Ctrl-C raises KeyboardInterrupt
/// within a second, and calls `progress`, None or a callable, with new reports. If `progress` raises an
/// exception, the work ends; if it returns False, the work is cancelled. The last call reports 1. The time
/// limit in seconds ends the work, too; 0: none. Rethrows exceptions of the work. The work must own all data
/// that it uses. Throws BudgetSpent, Cancelled, and exceptions of Python.
void run_watched(std::function<void(Watch&)> work, const pybind11::object& progress, double time_limit);

/// Waits a short time for work that was left running. Call it at the end of the interpreter.
void wait_for_abandoned();

}  // namespace collarmesh::python
