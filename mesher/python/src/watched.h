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

/// The work ended because it was asked to.
struct Cancelled : Error {
  using Error::Error;
};

/// Vertices, memory or time are spent.
struct BudgetSpent : Error {
  using Error::Error;
};

/// What the thread that works and the one that called it share. It outlives both: a call that is interrupted
/// leaves work behind that does not look at the flag soon enough.
class Watch {
 public:
  /// For the work: reports go to the thread that called, which asks Python.
  Execution execution();
  /// Throws Cancelled when the work is to end.
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
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::vector<News> news_;  // since the caller looked: the last of each phase, so that none is missed
  std::string stage_ = "start";
  bool done_ = false;
  std::exception_ptr failure_;
};

/// Do the work in a thread of its own. Meanwhile signals are looked at, so that Ctrl-C is KeyboardInterrupt
/// within a second, and `progress`, None or a callable, is told of what is new; what it raises ends the work,
/// and False cancels it. It hears 1 at the end. So does the time limit, in seconds; 0: none. What the work
/// throws is thrown here. The work must own all that it touches. Throws BudgetSpent, Cancelled, and what
/// Python raised.
void run_watched(std::function<void(Watch&)> work, const pybind11::object& progress, double time_limit);

/// Waits a while for work that was left behind; for the end of the interpreter.
void wait_for_abandoned();

}  // namespace collarmesh::python
