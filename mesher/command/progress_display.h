#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "collarmesh/progress.h"
#include "command/mesh_arguments.h"
#include "common/stopwatch.h"
#include "process/console.h"

namespace collarmesh::command {

/// A display of a command's progress on standard error: a bar on a terminal, or one JSON object per line.
/// Stages have fixed shares of the total fraction, which never decreases.
class ProgressDisplay {
 public:
  ProgressDisplay(const process::Console& console, ProgressStyle style);
  ~ProgressDisplay();  ///< clears the bar
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Begins a stage that takes the part [begin, end] of the whole.
  void begin_stage(std::string phase, double begin, double end);

  /// Prints lines above the bar; they stay.
  void print(const std::string& text);

  /// Shows progress within the stage.
  void update(const ProgressReport& report);

 private:
  enum class Form { bar, json, nothing };

  void redraw();
  void print_json();
  void keep_drawing();

  const process::Console& console_;
  Form form_;
  Stopwatch stopwatch_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool finished_ = false;
  std::string phase_;
  double begin_ = 0, end_ = 0, fraction_ = 0, json_printed_ = -1;
  std::size_t vertices_ = 0, tets_ = 0;
  std::thread drawing_;
};

/// Returns one line for display, at most `width` wide: "[#####.....] 52% refine 1.2M tets 3 s left".
std::string progress_line(const std::string& phase, double fraction, std::size_t tets, double seconds,
                          std::size_t width);

}  // namespace collarmesh::command
