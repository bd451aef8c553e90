#include "interrupt.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "staged_file.h"

namespace collarmesh::cli {

namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> interrupted{false}, by_user{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers need it");

std::mutex deadline_mutex;  // guards the three below
double time_limit = 0;
Clock::time_point deadline = Clock::time_point::max();
std::string stage_now = "stage: start";

extern "C" void on_interrupt(int) {
  by_user.store(true, std::memory_order_relaxed);
  interrupted.store(true, std::memory_order_relaxed);
}

bool asked_to_stop() {
  const std::lock_guard lock(deadline_mutex);
  if (Clock::now() > deadline) interrupted.store(true, std::memory_order_relaxed);
  return interrupted.load(std::memory_order_relaxed);
}

Stopped reason_to_stop() {
  if (by_user.load(std::memory_order_relaxed)) return Cancelled();
  const std::lock_guard lock(deadline_mutex);
  return {ExitCode::budget_hit,
          fmt::format(
              "the time limit of {} s is reached ({}); nothing was written; raise --time-limit, or --size "
              "for a coarser mesh",
              time_limit, stage_now)};
}

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

void set_time_limit(double seconds) {
  constexpr double a_year = 3e7;  // more than the clock's type may not hold
  const std::lock_guard lock(deadline_mutex);
  time_limit = seconds;
  deadline =
      seconds > 0 && seconds < a_year
          ? Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))
          : Clock::time_point::max();
}

void note_stage(const std::string& stage) {
  const std::lock_guard lock(deadline_mutex);
  stage_now = stage;
}

void stop_if_interrupted() {
  if (asked_to_stop()) throw reason_to_stop();
}

InputReading interruptible(InputReading reading) {
  reading.cancel = &interrupt_flag();
  reading.stop = [] { stop_if_interrupted(); };
  return reading;
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
      if (!asked_to_stop()) continue;
      if (command_ends_within(700ms) || !abandon_staged_files()) return;
      const Stopped reason = reason_to_stop();
      fmt::print(stderr, "\ncollarmesh: {}\n", reason.what());
      std::fflush(nullptr);
      std::_Exit(static_cast<int>(reason.code));
    }
  });
  return command();
}

}  // namespace collarmesh::cli
