#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <string>

#include "common/deadline.h"
#include "process/exit_code.h"

namespace collarmesh::process {

/// Thrown when a command ends early, without having written anything.
struct Stopped : std::runtime_error {
  Stopped(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

/// Thrown if the user asked to stop.
struct Cancelled : Stopped {
  Cancelled() : Stopped(ExitCode::cancelled, "cancelled; nothing was written") {}
};

/// The current stage of the command, and the size of its mesh.
struct StageReached {
  std::string stage = "start";
  std::size_t vertices = 0, tets = 0;  ///< 0: none yet
};

class Process;

/// The requests to stop the command: from the user, or because its time is up.
class Interrupts {
 public:
  explicit Interrupts(Process& process) : process_(process) {}

  /// Returns the flag that is set by the first SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGQUIT, and when the
  /// command's time or its CPU time is up. The second signal ends the program at once and removes unfinished
  /// files; the third one kills it.
  const std::atomic<bool>& flag() const { return flag_; }
  /// Throws Stopped if the user asked to stop or the time is up.
  void stop_if_asked();

  /// Limits the time of the command from now on, in seconds; 0: no limit.
  void set_time_limit(double seconds);
  /// Returns the seconds until the time is up, more than 0; 0: there is no limit.
  double time_left() const;

  /// Records the stage, for the message when the time is up and for reports of failures. `told` may describe
  /// the stage in more detail.
  void note_stage(StageReached reached, std::string told = {});
  StageReached stage_reached() const;

 private:
  friend class Process;  // for its signal handlers and its watcher

  bool is_asked();
  std::string advice() const;
  Stopped reason() const;

  Process& process_;
  std::atomic<bool> flag_{false}, out_of_processor_time_{false};
  std::atomic<int> signals_{0};  // signals from the user
  static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
                "signal handlers need it");
  bool unwatched_ = false;  // no thread could be made that watches the time

  mutable std::mutex deadline_mutex_;  // guards the three variables below
  double time_limit_ = 0;
  Deadline deadline_;
  std::string stage_told_ = "stage: start";

  mutable std::mutex stage_mutex_;  // guards the variable below; a thread that holds it allocates nothing,
                                    // except to report a failure
  StageReached stage_;
};

}  // namespace collarmesh::process
