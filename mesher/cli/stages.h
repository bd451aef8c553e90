#pragma once

#include <string>

#include "collarmesh/progress.h"
#include "common/recorded_costs.h"
#include "process/interrupt.h"
#include "progress_display.h"
#include "report/stage_times.h"

namespace collarmesh::cli {

/// Begins stages, both in the display and in the timing.
class Stages {
 public:
  Stages(ProgressStyle style, report::StageTimes& times) : display_(style), times_(times) {}

  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;
  ~Stages() { recorded_costs::write(); }

  void begin(const std::string& phase, double begin, double end, std::size_t tets = 0) {
    process::stop_if_interrupted();
    process::note_stage({phase, 0, tets});
    times_.begin(phase);
    recorded_costs::begin_stage(phase);
    display_.begin_stage(phase, begin, end);
  }
  /// One of those between building the complex and writing, with what is told in it.
  void update(ProgressReport report) {
    const double fraction = 0.08 + 0.85 * report.fraction;
    if (report.begins) {
      begin_ = fraction;
      begin(std::string(report.phase), begin_, begin_ + 1, report.tets);
      return;
    }
    process::note_stage({std::string(report.phase), report.vertices, report.tets});
    report.fraction = fraction - begin_;
    display_.update(report);
  }
  void print(const std::string& text) { display_.print(text); }

 private:
  ProgressDisplay display_;
  report::StageTimes& times_;
  double begin_ = 0;
};

}  // namespace collarmesh::cli
