#include "watched.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>

#include "common/deadline.h"

namespace py = pybind11;

namespace collarmesh::python {

namespace {

using namespace std::chrono_literals;

constexpr auto between_looks = 30ms;     // interval at which signals are checked
constexpr double until_abandoned = 0.7;  // seconds to wait after a request to stop
constexpr double until_interpreter_ends = 10;

std::atomic<int> abandoned{0};

/// Runs the handlers of signals that came since the last call. Returns false if one raised an exception.
bool signals_handled() {
  const py::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() == 0;
}

}  // namespace

Execution Watch::execution() {
  Execution execution;
  execution.cancel = &cancel_;
  execution.progress = [this](const ProgressReport& news) {
    report(std::string(news.phase), news.fraction);
    return true;
  };
  return execution;
}

void Watch::stop_if_asked() const {
  if (cancel_) throw Cancelled("cancelled");
}

void Watch::begin_stage(std::string stage) {
  stop_if_asked();
  report(std::move(stage), 0);
}

void Watch::report(std::string phase, double fraction) {
  const std::lock_guard lock(mutex_);
  stage_ = phase;
  if (news_.empty() || news_.back().phase != phase)
    news_.push_back({std::move(phase), fraction});
  else
    news_.back().fraction = fraction;
}

void run_watched(std::function<void(Watch&)> work, const py::object& progress, double time_limit) {
  const auto watch = std::make_shared<Watch>();
  std::thread([watch, work = std::move(work)]() mutable {
    std::exception_ptr failure;
    try {
      work(*watch);
    } catch (...) {
      failure = std::current_exception();
    }
    work = nullptr;  // destroys its data before the end is reported
    const std::lock_guard lock(watch->mutex_);
    watch->failure_ = failure;
    watch->done_ = true;
    watch->changed_.notify_all();
  }).detach();

  enum class Reason { none, time, callback, python } reason = Reason::none;
  std::exception_ptr raised;
  std::string stage;
  const Deadline limit = Deadline::in(time_limit);
  Deadline until_left;
  const py::gil_scoped_release release;
  const auto stop = [&](Reason why) {
    reason = why;
    watch->cancel_ = true;
    until_left = Deadline::in(until_abandoned);
  };
  std::unique_lock lock(watch->mutex_);
  double told = 0;
  for (;;) {
    watch->changed_.wait_for(lock, between_looks, [&] { return watch->done_; });
    const std::vector<Watch::News> news = std::exchange(watch->news_, {});
    stage = watch->stage_;
    const bool done = watch->done_;
    lock.unlock();
    if (reason == Reason::none) {
      try {
        for (const auto& [phase, fraction] : news) {
          if (progress.is_none() || fraction < told || reason != Reason::none) continue;
          const py::gil_scoped_acquire acquire;
          told = fraction;
          if (progress(phase, told).is(py::bool_(false))) stop(Reason::callback);
        }
        if (!signals_handled()) {
          const py::gil_scoped_acquire acquire;
          throw py::error_already_set();
        }
      } catch (...) {
        raised = std::current_exception();
        stop(Reason::python);
      }
      if (reason == Reason::none && !done && limit.passed()) stop(Reason::time);
    } else if (!done && until_left.passed()) {
      lock.lock();
      break;
    }
    lock.lock();
    if (done) break;
  }
  const bool done = watch->done_;
  const std::exception_ptr failure = watch->failure_;
  lock.unlock();
  if (!done) {
    ++abandoned;
    std::thread([watch] {
      std::unique_lock wait(watch->mutex_);
      watch->changed_.wait(wait, [&] { return watch->done_; });
      --abandoned;
    }).detach();
  }
  // The work knows the time limit, too, and may end first.
  if (reason == Reason::none && failure && limit.passed()) reason = Reason::time;
  if (reason == Reason::python) std::rethrow_exception(raised);
  if (reason == Reason::time)
    throw BudgetSpent(
        fmt::format("the time limit of {} s is reached ({}); raise time_limit, or size for a coarser mesh",
                    time_limit, stage));
  if (reason == Reason::callback) throw Cancelled(fmt::format("the run was stopped at {}", stage));
  if (failure) std::rethrow_exception(failure);
  if (!progress.is_none() && told < 1) {  // no stage reports 1, because none knows that it is the last one
    const py::gil_scoped_acquire acquire;
    progress(stage, 1.0);
  }
}

void wait_for_abandoned() {
  const py::gil_scoped_release release;
  const Deadline end = Deadline::in(until_interpreter_ends);
  while (abandoned > 0 && !end.passed()) std::this_thread::sleep_for(between_looks);
}

}  // namespace collarmesh::python
