#include "common/run_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace collarmesh {

/// A flag that becomes true when another flag is set or the time is up.
class RunControl::Deadline {
 public:
  Deadline(double seconds, const Execution& execution)
      : watcher_([this, seconds, &execution](const std::stop_token& end) {
          using namespace std::chrono_literals;
          using Clock = std::chrono::steady_clock;
          const Clock::time_point start = Clock::now();
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any ended;
          while (!ended.wait_for(lock, end, 10ms, [&end] { return end.stop_requested(); })) {
            if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) passed_ = true;
            if (passed_ || execution.cancelled()) flag_ = true;
          }
        }) {}

  bool passed() const { return passed_; }
  const std::atomic<bool>& flag() const { return flag_; }

 private:
  std::atomic<bool> flag_{false}, passed_{false};
  std::jthread watcher_;
};

RunControl::RunControl(const PipelineOptions& options, const Execution& execution, PipelineResult& made)
    : made_(made), time_limit_(options.mesh.time_limit), outer_(execution) {
  if (time_limit_ > 0) deadline_ = std::make_unique<Deadline>(time_limit_, execution);
  inner_.cancel = deadline_ ? &deadline_->flag() : execution.cancel;
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
  return (deadline_ && deadline_->passed()) || (of_attempt_ && of_attempt_->passed());
}

void RunControl::attempt(double share_of_time, const std::function<void()>& work) {
  if (!(time_limit_ > 0)) return work();
  using Clock = std::chrono::steady_clock;
  const double left = time_limit_ - std::chrono::duration<double>(Clock::now() - start_).count();
  if (left <= 0) return;
  const Execution outside = inner_;
  of_attempt_ = std::make_unique<Deadline>(share_of_time * left, outside);
  inner_.cancel = &of_attempt_->flag();
  const auto restore = [&] {
    inner_.cancel = outside.cancel;
    of_attempt_.reset();
  };
  try {
    work();
  } catch (...) {
    restore();
    throw;
  }
  restore();
}

/// Forwards the progress of a stage, scaled to its share of the whole.
bool RunControl::go_on(ProgressReport report) {
  fraction_ = std::max(fraction_, from_ + std::clamp(report.fraction, 0.0, 1.0) * (to_ - from_));
  report.fraction = fraction_;
  return outer_.progress(report);
}

}  // namespace collarmesh
