#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

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

/// Returns the flag that is set by the first SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGQUIT, and when the
/// command's time or its CPU time is up. The second signal ends the program at once and removes unfinished
/// files; the third one kills it.
const std::atomic<bool>& interrupt_flag();

/// Catches the signals from now on.
void install_interrupt_handlers();

/// Limits the time of the command from now on, in seconds; 0: no limit.
void set_time_limit(double seconds);
/// Returns the seconds until the time is up, more than 0; 0: there is no limit.
double time_left();

/// The current stage of the command, and the size of its mesh.
struct StageReached {
  std::string stage = "start";
  std::size_t vertices = 0, tets = 0;  ///< 0: none yet
};

/// Records the stage, for the message when the time is up and for reports of failures. `told` may describe
/// the stage in more detail.
void note_stage(StageReached reached, std::string told = {});
StageReached stage_reached();

/// Throws Stopped if the user asked to stop or the time is up.
void stop_if_interrupted();

/// Runs a command so that an interrupt ends the program within a second, whatever the command is doing.
/// Stages that check the flag return by themselves; other stages are abandoned, and their unfinished files
/// are removed.
ExitCode run_interruptible(const std::function<ExitCode()>& command);

}  // namespace collarmesh::process
