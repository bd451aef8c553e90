#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <memory>
#include <string_view>

#include "process/console.h"
#include "process/exit_code.h"
#include "process/failure.h"
#include "process/interrupt.h"
#include "process/staged_file.h"
#include "process/supervisor.h"

namespace collarmesh::process {

/// All state that a program shares with the system: its streams, signals, limits of time and memory, the
/// child that it watches, the files that it has not committed. main() makes the only object and never
/// destroys it, because signals and failed allocations may come until the very end.
class Process {
 public:
  /// Makes any later failed allocation end the program with exit code 5, wherever it happens. Unwinds
  /// nothing, because destructors and libraries may need memory, too. Removes unfinished files. Makes an
  /// uncaught exception end the program in the same way, with exit code 1.
  Process();
  ~Process() {
    Process* current = this;
    current_.compare_exchange_strong(current, nullptr);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  Console console;
  FailureReports reports;
  Supervisor supervisor{*this};
  Interrupts interrupts{*this};
  StagedFiles files{*this};

  /// Catches the signals that ask to stop, and those that report a limit of the system, from now on.
  void catch_signals();
  /// Passes signals that ask to stop on to `supervisor.child` from now on.
  void pass_signals_on();
  /// Makes any later crash end the program with a message: libraries such as HDF5 and MPI may crash if they
  /// get no memory. Both texts must outlive this object.
  void catch_crashes(std::string_view if_memory_is_short, std::string_view otherwise);

  /// Runs a command so that an interrupt ends the program within a second, whatever the command is doing.
  /// Stages that check the flag return by themselves; other stages are abandoned, and their unfinished files
  /// are removed. If no thread can be created, only stages that check the flag end.
  ExitCode run_interruptible(const std::function<ExitCode()>& command);

 private:
  class Watcher;

  // Handlers of signals and of failed allocations.
  static void on_interrupt(int number);
  static void on_processor_time(int number);
  static void on_time(int number);
  static void on_passed_signal(int number, siginfo_t* information, void* context);
  [[noreturn]] static void on_crash(int number);
  [[noreturn]] static void on_no_memory();
  [[noreturn]] static void on_uncaught_exception();
  [[gnu::constructor(101)]] static void before_all();
  [[noreturn]] static void end(ExitCode code, std::string_view message) noexcept;

  /// The only static variable: the system passes no pointer to a handler, so handlers find the object here.
  /// They use its lock-free atomic variables and, if they end the program, its files.
  static inline std::atomic<Process*> current_{nullptr};
  static_assert(std::atomic<Process*>::is_always_lock_free);

  /// A block that is freed when memory is used up, so that the program has some memory to end with.
  std::unique_ptr<char[]> reserve_;
  std::string_view told_of_memory_, told_of_crash_;
};

}  // namespace collarmesh::process
