#include "common/run_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace collarmesh {

/// A flag that becomes true when the execution's own flag is set or the deadline has passed.
class RunControl::Watch {
 public:
  Watch(Deadline deadline, const Execution& execution)
      : flag_(execution.cancelled()), watcher_([this, deadline, &execution](const std::stop_token& end) {
          using namespace std::chrono_literals;
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any ended;
          while (!ended.wait_for(lock, end, 10ms, [&end] { return end.stop_requested(); })) {
            if (deadline.passed()) passed_ = true;
            if (passed_ || execution.cancelled()) flag_ = true;
          }
        }) {}

  bool passed() const { return passed_; }
  const std::atomic<bool>& flag() const { return flag_; }

 private:
  std::atomic<bool> flag_, passed_{false};
  std::jthread watcher_;
};

RunControl::RunControl(const PipelineOptions& options, const Execution& execution, PipelineResult& made)
    : made_(made),
      time_limit_(options.mesh.time_limit),
      deadline_(Deadline::in(time_limit_)),
      outer_(execution) {
  if (deadline_.exists()) watch_ = std::make_unique<Watch>(deadline_, execution);
  inner_.cancel = watch_ ? &watch_->flag() : execution.cancel;
  if (execution.progress) inner_.progress = [this](const ProgressReport& report) { return go_on(report); };
}

RunControl::~RunControl() = default;

void RunControl::begin(std::string_view stage, double from, double to) {
  stage_ = stage;
  from_ = from;
  to_ = to;
  stop_if_asked();
  if (outer_.progress && !go_on({.phase = stage,
                                 .fraction = 0,
                                 .vertices = made_.result.mesh.points.size(),
                                 .tets = made_.result.mesh.tets.size(),
                                 .begins = true}))
    stop();
}

void RunControl::watch(const std::function<void(const Execution&)>& stage) {
  Execution watched = inner_;
  bool stopped = false;
  if (inner_.progress)
    watched.progress = [&](const ProgressReport& report) {
      stopped |= !inner_.progress(report);
      return !stopped;
    };
  stage(watched);
  if (stopped) stop();
  stop_if_asked();
}

void RunControl::stop_if_asked(bool asked) {
  if (asked || inner_.cancelled()) stop();
}

void RunControl::stop() {
  MeshResult& result = made_.result;
  result.status = out_of_time() ? MeshStatus::budget_hit : MeshStatus::cancelled;
  result.message =
      out_of_time()
          ? fmt::format("the time limit of {} s is reached ({}); raise it, or size for a coarser mesh",
                        time_limit_, stage_)
          : fmt::format("the run was stopped ({})", stage_);
  throw Ended();
}

bool RunControl::out_of_time() const {
  return (watch_ && watch_->passed()) ||
         std::ranges::any_of(attempts_, [](const auto& watch) { return watch->passed(); });
}

void RunControl::attempt(double share_of_time, const std::function<void()>& work) {
  if (!deadline_.exists()) return work();
  const double remaining = deadline_.remaining();
  if (remaining <= 0) return;
  const Execution outside = inner_;
  attempts_.push_back(std::make_unique<Watch>(Deadline::in(share_of_time * remaining), outside));
  inner_.cancel = &attempts_.back()->flag();
  const auto restore = [&] {
    inner_.cancel = outside.cancel;
    attempts_.pop_back();
  };
  try {
    work();
  } catch (...) {
    restore();
    throw;
  }
  restore();
}

/// Forwards the progress of a stage, scaled to its share of the whole run.
bool RunControl::go_on(ProgressReport report) {
  fraction_ = std::max(fraction_, from_ + std::clamp(report.fraction, 0.0, 1.0) * (to_ - from_));
  report.fraction = fraction_;
  return outer_.progress(report);
}

}  // namespace collarmesh
