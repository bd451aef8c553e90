#pragma once

#include <string>

#include "collarmesh/progress.h"
#include "command/progress_display.h"
#include "process/process.h"
#include "report/stage_times.h"

namespace collarmesh::command {

/// A reporter of the stages of a command, to the progress display and to the table of times.
class Stages {
 public:
  Stages(process::Process& process, const RunOptions& options, report::StageTimes& times)
      : interrupts_(process.interrupts),
        display_(process.console, options.quiet ? ProgressStyle::off : options.progress),
        times_(times) {}

  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;
  ~Stages();

  void begin(const std::string& phase, double begin, double end, std::size_t tets = 0);
  /// Forwards a progress report of `run_pipeline`, scaled to its share of the command.
  void update(ProgressReport report);
  void print(const std::string& text) { display_.print(text); }

 private:
  process::Interrupts& interrupts_;
  ProgressDisplay display_;
  report::StageTimes& times_;
  double begin_ = 0;
};

}  // namespace collarmesh::command
