#include "process/interrupt.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "common/deadline.h"
#include "process/console.h"
#include "process/failure.h"
#include "process/staged_file.h"
#include "process/supervisor.h"

namespace collarmesh::process {

namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> signals{0};  // signals from the user
std::atomic<bool> out_of_processor_time{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "signal handlers need it");

std::mutex deadline_mutex;  // guards the three variables below
double time_limit = 0;
Deadline deadline;
std::string stage_told = "stage: start";

std::mutex stage_mutex;  // guards the variable below; a thread that holds it allocates nothing, except to
                         // report a failure
StageReached stage_now;

extern "C" void on_interrupt(int number) {
  interrupted.store(true, std::memory_order_relaxed);
  if (signals.fetch_add(1, std::memory_order_relaxed) < 2) return;
  std::signal(number, SIG_DFL);  // the signal raised next kills the program
  std::raise(number);
}

extern "C" void on_processor_time(int) {
  out_of_processor_time.store(true, std::memory_order_relaxed);
  interrupted.store(true, std::memory_order_relaxed);
}

extern "C" void on_time(int) { interrupted.store(true, std::memory_order_relaxed); }

/// Sets the flag at the time limit, if no thread can watch. Only stages that check the flag end then.
void set_flag_at_the_deadline() {
  if (!deadline.exists()) return;
  const double seconds = deadline.as_option();
  std::signal(SIGALRM, on_time);
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - std::floor(seconds)));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

bool watched = false;

bool asked_to_stop() {
  const std::lock_guard lock(deadline_mutex);
  if (deadline.passed()) interrupted.store(true, std::memory_order_relaxed);
  return interrupted.load(std::memory_order_relaxed);
}

/// Returns advice that depends on the stage in which the time ran out.
std::string coarser_text() {
  const std::string stage = stage_reached().stage;
  if (stage == "start" || stage == "read")
    return "or read less at once: save the solids of a large assembly as separate files";
  if (stage == "complex")
    return "or, because many intersecting facets take the time, try another --repair-tolerance or --repair "
           "wrap";
  return "or --size for a coarser mesh; if the input is meshed, --repair wrap helps, too: it ignores detail "
         "much finer than the size";
}

Stopped reason_to_stop() {
  if (signals.load(std::memory_order_relaxed) > 0) return Cancelled();
  const std::lock_guard lock(deadline_mutex);
  if (out_of_processor_time.load(std::memory_order_relaxed))
    return {
        ExitCode::budget_hit,
        fmt::format(
            "the system's limit of CPU time is reached ({}); nothing was written; raise it (ulimit -t), {}",
            stage_told, coarser_text())};
  return {ExitCode::budget_hit,
          fmt::format("the time limit of {} s is reached ({}); nothing was written; raise --time-limit, {}",
                      time_limit, stage_told, coarser_text())};
}

}  // namespace

const std::atomic<bool>& interrupt_flag() { return interrupted; }

void install_interrupt_handlers() {
  struct sigaction action = {}, before = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM}) sigaction(number, &action, nullptr);
  for (const int number : {SIGHUP, SIGQUIT})  // if nohup has set them to be ignored, keep that
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      sigaction(number, &action, nullptr);
  std::signal(SIGXCPU, on_processor_time);
  // The CPU seconds, of all threads, that remain to end after the soft limit. `ulimit -t` sets both limits,
  // and the signal of the hard limit cannot be caught.
  constexpr rlim_t to_end_within = 2;  // CPU seconds of all threads
  rlimit limit = {};
  if (getrlimit(RLIMIT_CPU, &limit) == 0 && limit.rlim_max != RLIM_INFINITY &&
      limit.rlim_max > to_end_within && limit.rlim_cur > limit.rlim_max - to_end_within) {
    limit.rlim_cur = limit.rlim_max - to_end_within;
    setrlimit(RLIMIT_CPU, &limit);
  }
  // Turns the signals for a file that grows too large and for a pipe that nobody reads into ordinary write
  // errors.
  for (const int number : {SIGXFSZ, SIGPIPE}) std::signal(number, SIG_IGN);
}

void set_time_limit(double seconds) {
  const std::lock_guard lock(deadline_mutex);
  time_limit = seconds;
  deadline = Deadline::in(seconds);
  supervise_time(deadline);
  if (!watched) set_flag_at_the_deadline();
}

double time_left() {
  const std::lock_guard lock(deadline_mutex);
  return deadline.as_option();
}

void note_stage(StageReached reached, std::string told) {
  if (told.empty()) {
    told = "stage: " + reached.stage;
    if (reached.vertices > 0) told += fmt::format(", {} vertices", reached.vertices);
    if (reached.tets > 0) told += fmt::format(", {} tets", reached.tets);
  }
  {
    const std::lock_guard lock(stage_mutex);
    std::swap(stage_now, reached);
  }
  const std::lock_guard lock(deadline_mutex);
  stage_told = std::move(told);
}

StageReached stage_reached() {
  const std::lock_guard lock(stage_mutex);
  return stage_now;
}

void stop_if_interrupted() {
  if (asked_to_stop()) throw reason_to_stop();
}

namespace {

/// A thread that watches a command. If the command does not end in time, ends the program.
class Watcher {
 public:
  /// Starts the thread. Throws std::system_error if the system can create none.
  Watcher() : thread_([this](const std::stop_token& end) { watch(end); }) {}

 private:
  bool command_ends_within(const std::stop_token& end, std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, end, time, [&end] { return end.stop_requested(); });
  }

  void watch(const std::stop_token& end) {
    using namespace std::chrono_literals;
    while (!command_ends_within(end, 50ms)) {
      if (!asked_to_stop()) continue;
      for (int waited = 0; waited < 14 && signals.load(std::memory_order_relaxed) < 2; ++waited)
        if (command_ends_within(end, 50ms)) return;
      if (!abandon_staged_files()) return;
      const Stopped reason = reason_to_stop();
      tell("\ncollarmesh: {}\n", reason.what());
      failed(reason.code, reason.what());
      std::_Exit(static_cast<int>(reason.code));
    }
  }

  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};

}  // namespace

ExitCode run_interruptible(const std::function<ExitCode()>& command) {
  std::optional<Watcher> watcher;
  try {
    watcher.emplace();
    watched = true;
  } catch (const std::system_error&) {
    watched = false;
  }
  return command();
}

}  // namespace collarmesh::process
