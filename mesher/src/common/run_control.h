#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/progress.h"
#include "common/deadline.h"

namespace collarmesh {

/// The exception that ends a run early; `PipelineResult::result` says why.
struct Ended {};

/// The time limit, the cancellation and the progress that all stages of a run share.
class RunControl {
 public:
  /// Keeps references to the execution and the result. The time starts now.
  RunControl(const PipelineOptions& options, const Execution& execution, PipelineResult& made);
  ~RunControl();
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;

  /// Returns the execution for the stages; it scales their progress to shares of the whole run.
  const Execution& execution() const { return inner_; }

  /// Begins a stage, whose progress goes from one fraction of the whole run to another. Throws Ended.
  void begin(std::string_view stage, double from, double to);
  /// Reports the progress of the only stage as that of the whole run.
  void begin_only_stage() { to_ = 1; }

  /// Runs a stage, and throws Ended if the progress function ended it early. For stages whose results do not
  /// tell this.
  void watch(const std::function<void(const Execution&)>& stage);

  /// Throws Ended if the run is cancelled or out of time, or if `asked` is true.
  void stop_if_asked(bool asked = false);
  /// Writes the reason into the result and throws Ended.
  [[noreturn]] void stop();
  bool out_of_time() const;

  /// Runs an attempt at a better result in at most this share of the remaining time, so that the time limit
  /// cannot lose the result at hand. When the share is used up, stages end as at the time limit. Does nothing
  /// if no time remains.
  void attempt(double share_of_time, const std::function<void()>& work);

 private:
  class Watch;
  bool go_on(ProgressReport report);

  PipelineResult& made_;
  const double time_limit_;  // seconds; 0: none
  const Deadline deadline_;
  const Execution& outer_;
  Execution inner_;
  std::unique_ptr<Watch> watch_;
  std::vector<std::unique_ptr<Watch>> attempts_;  // one inside the other
  std::string_view stage_;
  double from_ = 0, to_ = 0, fraction_ = 0;  // fractions of the whole run: begin and end of the stage, and
                                             // the last one reported
};

}  // namespace collarmesh
