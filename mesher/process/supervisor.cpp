#include "process/supervisor.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>

#include "process/process.h"

namespace collarmesh::process {

namespace {

constexpr int running = -1;

void copy(std::string_view text, char* place, std::size_t size) {
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(place, text.data(), length);
  place[length] = '\0';
}

std::string name_of(int number) {
  const char* const name = sigabbrev_np(number);
  return name == nullptr ? fmt::format("signal {}", number) : fmt::format("SIG{}", name);
}

}  // namespace

/// The data that child and supervisor share. Long texts are cut off.
struct Supervisor::Shared {
  static_assert(std::atomic<Deadline>::is_always_lock_free);  // processes share it

  std::atomic<int> result{running};
  std::atomic<bool> in_cad{false};
  std::atomic<Deadline> end{Deadline()};      // deadline of the process
  std::atomic<Deadline> cad_end{Deadline()};  // deadline of OpenCASCADE's work
  std::array<char, 128> doing{};
  std::array<char, 1024> file{};
  std::array<char, 16384> folders{};  // paths, each with its terminating zero
  std::size_t folders_end = 0;
};

/// An object that blocks SIGCHLD as long as it exists, so that the supervisor can wait for the end of a
/// child.
class Supervisor::ChildSignal {
 public:
  ChildSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &signal_, &before_);
  }
  ~ChildSignal() { unblock(); }
  ChildSignal(const ChildSignal&) = delete;
  ChildSignal& operator=(const ChildSignal&) = delete;

  void unblock() const { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  /// Waits until a child ends, another signal comes or this time (less than a second) is over.
  void wait(std::chrono::nanoseconds time) const {
    const timespec most{0, time.count()};
    sigtimedwait(&signal_, nullptr, &most);
  }

 private:
  sigset_t signal_, before_;
};

/// Waits for the child and returns how it ended; kills it when a limit is exceeded.
int Supervisor::wait_for_child(const ChildSignal& ended_signal, bool& out_of_time) const {
  using namespace std::chrono_literals;
  constexpr double grace = 3;  // seconds; the child's own watcher ends it within one second
  for (int status = 0;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return 0;
    if (shared_->end.load().passed(grace) || shared_->cad_end.load().passed()) {
      out_of_time = true;
      kill(child, SIGKILL);
    }
    ended_signal.wait(20ms);
  }
}

ExitCode Supervisor::told(ExitCode code, const std::string& message) const {
  process_.console.tell("collarmesh: {}\n", message);
  process_.reports.failed(code, message);
  return code;
}

ExitCode Supervisor::reason_for(int status, bool out_of_time) const {
  if (const int result = shared_->result.load(); result != running) return static_cast<ExitCode>(result);
  for (std::size_t at = 0; at < shared_->folders_end; at += std::strlen(&shared_->folders[at]) + 1)
    remove_dead_folder(&shared_->folders[at]);
  if (out_of_time && shared_->in_cad.load() && shared_->cad_end.load().passed())
    return told(ExitCode::unreadable,
                fmt::format("{}: OpenCASCADE took too long while {}; the file is probably damaged; if it is "
                            "not, allow more time with --time-limit",
                            shared_->file.data(), shared_->doing.data()));
  if (out_of_time) return told(ExitCode::budget_hit, "the time limit is reached; nothing was written");
  if (!WIFSIGNALED(status)) return static_cast<ExitCode>(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  if (asked_to_stop) return told(ExitCode::cancelled, "cancelled; nothing was written");
  if (number == SIGKILL)
    return told(
        ExitCode::budget_hit,
        "the program was killed, probably because the machine's memory is used up; nothing was written");
  if (number == SIGXCPU)
    return told(ExitCode::budget_hit, "the system's limit of CPU time is reached; nothing was written");
  if (shared_->in_cad.load())
    return told(ExitCode::unreadable,
                fmt::format("{}: OpenCASCADE crashed while {} ({}); the file is damaged, or its shape is too "
                            "difficult for OpenCASCADE; check and repair it in the program that made it",
                            shared_->file.data(), shared_->doing.data(), name_of(number)));
  return told(
      ExitCode::internal_error,
      fmt::format("internal error: {}; please report it with the input and the options", name_of(number)));
}

void Supervisor::be_the_child(pid_t parent, const std::function<ExitCode()>& command) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) std::_Exit(static_cast<int>(ExitCode::cancelled));
  const ExitCode code = command();
  shared_->result.store(static_cast<int>(code));  // keep the exit code even if unloading libraries fails
  std::exit(static_cast<int>(code));
}

ExitCode Supervisor::run(const std::function<ExitCode()>& command) {
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  shared_ = memory == MAP_FAILED ? nullptr : new (memory) Shared;
  if (shared_ == nullptr) return command();
  const pid_t parent = getpid();
  const ChildSignal child_signal;
  const pid_t made = fork();
  if (made == 0) {
    child_signal.unblock();
    be_the_child(parent, command);
  }
  if (made < 0) {
    child_signal.unblock();
    shared_ = nullptr;
    return command();
  }
  child = made;
  process_.pass_signals_on();
  std::signal(SIGPIPE, SIG_IGN);
  bool out_of_time = false;
  const int status = wait_for_child(child_signal, out_of_time);
  return reason_for(status, out_of_time);
}

CadWork::CadWork(Supervisor& supervisor, std::string_view doing, std::string_view file, double seconds)
    : supervisor_(supervisor) {
  Supervisor::Shared* const shared = supervisor.shared_;
  if (shared == nullptr) return;
  copy(doing, shared->doing.data(), shared->doing.size());
  copy(file, shared->file.data(), shared->file.size());
  if (seconds > 0 && !shared->end.load().exists()) shared->cad_end.store(Deadline::in(seconds));
  shared->in_cad.store(true);
}

CadWork::~CadWork() {
  Supervisor::Shared* const shared = supervisor_.shared_;
  if (shared == nullptr) return;
  shared->in_cad.store(false);
  shared->cad_end.store({});
}

void Supervisor::limit_time(Deadline deadline) {
  if (shared_ != nullptr) shared_->end.store(deadline);
}

void Supervisor::add_folder(std::string_view folder) {
  if (shared_ == nullptr || folder.size() >= shared_->folders.size() - shared_->folders_end) return;
  copy(folder, &shared_->folders[shared_->folders_end], folder.size() + 1);
  shared_->folders_end += folder.size() + 1;
}

}  // namespace collarmesh::process
