#include "interrupt.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>
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
  std::packaged_task<ExitCode()> task(command);
  std::future<ExitCode> result = task.get_future();
  std::thread worker(std::move(task));
  while (result.wait_for(50ms) != std::future_status::ready) {
    if (!interrupted.load(std::memory_order_relaxed)) continue;
    if (result.wait_for(700ms) == std::future_status::ready) break;
    if (!abandon_staged_files()) break;
    fmt::print(stderr, "\ncollarmesh: {}\n", Cancelled().what());
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(ExitCode::cancelled));
  }
  worker.join();
  return result.get();
}

}  // namespace collarmesh::cli
