#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "collarmesh/pipeline.h"
#include "collarmesh/progress.h"

namespace collarmesh::pipeline {

/// Thrown if a stage stops early; `PipelineResult::result` says why.
struct Ended {};

/// One time limit, one way to cancel and one progress for all stages of a run.
class RunControl {
 public:
  /// Keeps the execution and the result by reference. The time starts now.
  RunControl(const PipelineOptions& options, const Execution& execution, PipelineResult& made);
  ~RunControl();
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;

  /// Returns the execution that stages obey: its progress is a share of the whole.
  const Execution& execution() const { return inner_; }

  /// Begins a stage, whose progress goes from one fraction of the whole to another. Throws Ended.
  void begin(std::string_view stage, double from, double to);
  /// Reports the progress of the next stage as that of the whole.
  void begin_only_stage() { to_ = 1; }

  /// Runs a stage that ends early, without saying so, when progress says so. Throws Ended.
  void watch(const std::function<void(const Execution&)>& stage);

  /// Throws Ended if the run is cancelled or out of time.
  void stop_if_asked();
  /// Says in the result why the run ends, and throws Ended.
  [[noreturn]] void stop();
  bool out_of_time() const;

 private:
  class Deadline;
  bool go_on(ProgressReport report);

  PipelineResult& made_;
  const double time_limit_;  // seconds; 0: none
  const Execution& outer_;
  Execution inner_;
  std::unique_ptr<Deadline> deadline_;
  std::string_view stage_;
  double from_ = 0, to_ = 0, fraction_ = 0;  // of the stage in the whole
};

}  // namespace collarmesh::pipeline
