#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

#include "exit_code.h"

namespace collarmesh::cli {

/// Thrown between stages once the user asked to stop.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled; nothing was written") {}
};

/// Set by the first Ctrl-C (SIGINT) or SIGTERM; the second one kills.
const std::atomic<bool>& interrupt_flag();

/// Catch the signals from now on.
void install_interrupt_handlers();

/// Throws Cancelled when the user asked to stop.
void stop_if_interrupted();

/// Run a command so that an interrupt ends the program within a second whatever it is doing: stages
/// that watch the flag return by themselves, others are abandoned, with their unfinished files.
ExitCode run_interruptible(const std::function<ExitCode()>& command);

}  // namespace collarmesh::cli
