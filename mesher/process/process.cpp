#include "process/process.h"

#include <gmp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <system_error>
#include <thread>

#include "process/machine.h"

namespace collarmesh::process {

namespace {

constexpr std::string_view program = "collarmesh: ";  // prefix of messages

void print(std::string_view message) {
  if (write(STDERR_FILENO, message.data(), message.size()) < 0) {
    // The error has no place to be reported, because standard error itself failed.
  }
}

// GMP's own functions abort if they get no memory; with these the new-handler ends the program.
void* gmp_allocate(std::size_t bytes) { return ::operator new(bytes); }
void gmp_free(void* block, std::size_t) { ::operator delete(block); }
void* gmp_reallocate(void* block, std::size_t old_bytes, std::size_t bytes) {
  void* const grown = ::operator new(bytes);
  std::memcpy(grown, block, old_bytes < bytes ? old_bytes : bytes);
  ::operator delete(block);
  return grown;
}

/// Catches a signal unless the process was started with this signal ignored, as by nohup.
void catch_unless_ignored(int number, const struct sigaction& action) {
  struct sigaction before = {};
  if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(number, &action, nullptr);
}

}  // namespace

void Process::before_all() {
  // This function runs before the program's global variables are initialized, because their initialization
  // allocates memory.
  std::set_new_handler(on_no_memory);
}

Process::Process() {
  constexpr std::size_t for_the_end = std::size_t{1} << 18;
  reserve_ = std::make_unique<char[]>(for_the_end);
  mp_set_memory_functions(gmp_allocate, gmp_reallocate, gmp_free);
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_uncaught_exception);
  current_ = this;
}

void Process::end(ExitCode code, std::string_view message) noexcept {
  std::set_new_handler(nullptr);
  Process* const process = current_;
  if (process != nullptr) process->reserve_.reset();
  // If all files are in place, the command has succeeded.
  if (process != nullptr && !process->files.abandon()) std::_Exit(0);
  print(message);
  if (process != nullptr)
    process->reports.failed(code, message.substr(program.size(), message.find('\n') - program.size()));
  std::_Exit(static_cast<int>(code));
}

void Process::on_no_memory() {
  end(ExitCode::budget_hit,
      "collarmesh: the memory is used up; nothing was written; raise --max-memory, or --size for a coarser "
      "mesh\n");
}

void Process::on_uncaught_exception() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    on_no_memory();
  } catch (...) {
  }
  end(ExitCode::internal_error,
      "collarmesh: internal error; please report it with the input and the options\n");
}

void Process::on_crash(int) {
  const bool is_short = memory_is_short();
  Process* const process = current_;
  if (process != nullptr) {
    process->files.abandon();
    print(is_short ? process->told_of_memory_ : process->told_of_crash_);
  }
  std::_Exit(static_cast<int>(is_short ? ExitCode::budget_hit : ExitCode::internal_error));
}

void Process::catch_crashes(std::string_view if_memory_is_short, std::string_view otherwise) {
  told_of_memory_ = if_memory_is_short;
  told_of_crash_ = otherwise;
  std::signal(SIGSEGV, on_crash);
}

void Process::on_interrupt(int number) {
  if (Process* const process = current_; process != nullptr) {
    process->interrupts.flag_.store(true, std::memory_order_relaxed);
    if (process->interrupts.signals_.fetch_add(1, std::memory_order_relaxed) < 2) return;
  }
  std::signal(number, SIG_DFL);  // the signal raised next kills the program
  std::raise(number);
}

void Process::on_processor_time(int number) {
  if (Process* const process = current_; process != nullptr)
    process->interrupts.out_of_processor_time_.store(true, std::memory_order_relaxed);
  on_time(number);
}

void Process::on_time(int) {
  if (Process* const process = current_; process != nullptr)
    process->interrupts.flag_.store(true, std::memory_order_relaxed);
}

/// Passes a signal on to the child, unless it is from the terminal, which sends it to the child as well.
void Process::on_passed_signal(int number, siginfo_t* information, void*) {
  Process* const process = current_;
  if (process == nullptr) return;
  process->supervisor.asked_to_stop = true;
  const pid_t child = process->supervisor.child;
  if (information->si_code != SI_KERNEL && child > 0) kill(child, number);
}

void Process::pass_signals_on() {
  struct sigaction action = {};
  action.sa_sigaction = on_passed_signal;
  action.sa_flags = static_cast<int>(SA_SIGINFO | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) catch_unless_ignored(number, action);
}

void Process::catch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM}) sigaction(number, &action, nullptr);
  for (const int number : {SIGHUP, SIGQUIT}) catch_unless_ignored(number, action);
  std::signal(SIGXCPU, on_processor_time);
  // `ulimit -t` sets the soft and the hard limit to the same time, and the signal of the hard limit cannot be
  // caught. With a lower soft limit some seconds of CPU time, summed over threads, remain for the end.
  constexpr rlim_t to_end_within = 2;
  rlimit limit = {};
  if (getrlimit(RLIMIT_CPU, &limit) == 0 && limit.rlim_max != RLIM_INFINITY &&
      limit.rlim_max > to_end_within && limit.rlim_cur > limit.rlim_max - to_end_within) {
    limit.rlim_cur = limit.rlim_max - to_end_within;
    setrlimit(RLIMIT_CPU, &limit);
  }
  // Without these signals, writing to a file that grows too large or to a pipe that nobody reads is an
  // ordinary error.
  for (const int number : {SIGXFSZ, SIGPIPE}) std::signal(number, SIG_IGN);
}

/// A thread that ends the program if the command does not return soon after a request to stop.
class Process::Watcher {
 public:
  /// Starts the thread. Throws std::system_error if the system can create none.
  explicit Watcher(Process& process)
      : process_(process), thread_([this](const std::stop_token& end) { watch(end); }) {}

 private:
  bool command_ends_within(const std::stop_token& end, std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, end, time, [&end] { return end.stop_requested(); });
  }

  void watch(const std::stop_token& end) {
    using namespace std::chrono_literals;
    while (!command_ends_within(end, 50ms)) {
      if (!process_.interrupts.is_asked()) continue;
      for (int waited = 0; waited < 14 && process_.interrupts.signals_.load(std::memory_order_relaxed) < 2;
           ++waited)
        if (command_ends_within(end, 50ms)) return;
      if (!process_.files.abandon()) return;
      const Stopped reason = process_.interrupts.reason();
      process_.console.tell("\ncollarmesh: {}\n", reason.what());
      process_.reports.failed(reason.code, reason.what());
      std::_Exit(static_cast<int>(reason.code));
    }
  }

  Process& process_;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};

ExitCode Process::run_interruptible(const std::function<ExitCode()>& command) {
  std::optional<Watcher> watcher;
  try {
    watcher.emplace(*this);
  } catch (const std::system_error&) {  // then only stages that check the flag end at the time limit
    interrupts.unwatched_ = true;
    std::signal(SIGALRM, on_time);
  }
  return command();
}

}  // namespace collarmesh::process
