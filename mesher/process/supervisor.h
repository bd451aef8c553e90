#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "common/deadline.h"
#include "process/exit_code.h"

namespace collarmesh::process {

class Process;

/// The runner of commands in child processes, which it watches. In a child, its functions pass information to
/// the watching process.
class Supervisor {
 public:
  explicit Supervisor(Process& process) : process_(process) {}

  /// Runs a command in a child process, which this process only watches. CAD files can make OpenCASCADE crash
  /// or run forever. In that case the child dies; this process then reports the file and the operation,
  /// removes unfinished files and returns the exit code of the failure. Passes signals that ask to stop on to
  /// the child; the child dies with this process. Runs the command here if no child can be created.
  /// Precondition: there is only one thread. Cost: about a millisecond.
  ExitCode run(const std::function<ExitCode()>& command);

  /// Tells the supervisor, if there is one, when the process must end.
  void limit_time(Deadline deadline);
  /// Tells the supervisor, if there is one, to remove this folder if the process dies.
  void add_folder(std::string_view folder);

  /// The child to which signals are passed on; 0: none.
  std::atomic<pid_t> child{0};
  /// Whether a signal has asked this process to stop since it began to pass signals on.
  std::atomic<bool> asked_to_stop{false};
  static_assert(std::atomic<pid_t>::is_always_lock_free, "signal handlers need it");

 private:
  friend class CadWork;
  struct Shared;
  class ChildSignal;

  [[noreturn]] void be_the_child(pid_t parent, const std::function<ExitCode()>& command);
  int wait_for_child(const ChildSignal& ended_signal, bool& out_of_time) const;
  ExitCode reason_for(int status, bool out_of_time) const;
  ExitCode told(ExitCode code, const std::string& message) const;

  Process& process_;
  Shared* shared_ = nullptr;  // memory that child and supervisor share; null without a supervisor
};

/// An object that reports work of OpenCASCADE on a file, such as "cutting faces into triangles", as long as
/// it exists. If two of these objects are nested, the inner one counts. One thread must make all of them.
class CadWork {
 public:
  /// Begins the work. It may take this many seconds (0: no limit); a time limit of the process replaces this.
  CadWork(Supervisor& supervisor, std::string_view doing, std::string_view file, double seconds = 0);
  ~CadWork();
  CadWork(const CadWork&) = delete;
  CadWork& operator=(const CadWork&) = delete;

 private:
  Supervisor& supervisor_;
};

}  // namespace collarmesh::process
