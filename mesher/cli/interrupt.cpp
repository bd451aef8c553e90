#include "interrupt.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stop_token>
#include <thread>

#include "staged_file.h"

namespace collarmesh::cli {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers need it");

extern "C" void on_interrupt(int) { interrupted.store(true, std::memory_order_relaxed); }

}  // namespace

const std::atomic<bool>& interrupt_flag() { return interrupted; }

void install_interrupt_handlers() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grew too large is a write error like others
}

void stop_if_interrupted() {
  if (interrupted.load(std::memory_order_relaxed)) throw Cancelled();
}

ExitCode run_interruptible(const std::function<ExitCode()>& command) {
  using namespace std::chrono_literals;
  std::mutex mutex;
  std::condition_variable_any ended;
  // Ends with the command, or ends the program in its place.
  const std::jthread watcher([&](const std::stop_token& end) {
    std::unique_lock lock(mutex);
    const auto command_ends_within = [&](std::chrono::milliseconds time) {
      return ended.wait_for(lock, end, time, [&end] { return end.stop_requested(); });
    };
    while (!command_ends_within(50ms)) {
      if (!interrupted.load(std::memory_order_relaxed)) continue;
      if (command_ends_within(700ms) || !abandon_staged_files()) return;
      fmt::print(stderr, "\ncollarmesh: {}\n", Cancelled().what());
      std::fflush(nullptr);
      std::_Exit(static_cast<int>(ExitCode::cancelled));
    }
  });
  return command();
}

}  // namespace collarmesh::cli
