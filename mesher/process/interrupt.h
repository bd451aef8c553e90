#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

#include "process/exit_code.h"

namespace collarmesh::process {

/// Thrown when a command ends before it is done. Nothing was written.
struct Stopped : std::runtime_error {
  Stopped(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

/// The user asked to stop.
struct Cancelled : Stopped {
  Cancelled() : Stopped(ExitCode::cancelled, "cancelled; nothing was written") {}
};

/// Set by the first SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGQUIT, and when the time is up, the command's or
/// the processor's. The second signal ends the program at once, without unfinished files; the third one kills
/// it.
const std::atomic<bool>& interrupt_flag();

/// Catch the signals from now on.
void install_interrupt_handlers();

/// The command has so many seconds from now on for everything it does; 0: any time.
void set_time_limit(double seconds);

/// What the command is doing, and how much there is of it.
struct StageReached {
  std::string stage = "start";
  std::size_t vertices = 0, tets = 0;  ///< 0: none yet
};

/// For the message when the time is up, where `told` says more than the stage, and for reports of failures.
void note_stage(StageReached reached, std::string told = {});
StageReached stage_reached();

/// Throws Stopped when the user asked to stop or the time is up.
void stop_if_interrupted();

/// Runs a command so that an interrupt ends the program within a second whatever it is doing: stages that
/// watch the flag return by themselves, others are abandoned, with their unfinished files.
ExitCode run_interruptible(const std::function<ExitCode()>& command);

}  // namespace collarmesh::process
