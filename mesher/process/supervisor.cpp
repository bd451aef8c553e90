#include "process/supervisor.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>

#include "process/console.h"
#include "process/failure.h"
#include "process/staged_file.h"

namespace collarmesh::process {

namespace {

constexpr std::array stop_signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
constexpr int running = -1;

/// The data that child and supervisor share. Long texts are cut off.
struct Shared {
  std::atomic<int> result{running};
  std::atomic<bool> in_cad{false};
  std::atomic<Deadline> end{Deadline()};      // for the process
  std::atomic<Deadline> cad_end{Deadline()};  // for OpenCASCADE's current work
  std::array<char, 128> doing{};
  std::array<char, 1024> file{};
  std::array<char, 16384> folders{};  // paths, each with its terminating zero
  std::size_t folders_end = 0;
};

Shared* shared = nullptr;  // null without a supervisor

void copy(std::string_view text, char* place, std::size_t size) {
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(place, text.data(), length);
  place[length] = '\0';
}

volatile std::sig_atomic_t asked_to_stop = 0;
volatile pid_t child = 0;

/// Passes a signal on to the child. A terminal sends its signals to the child as well.
extern "C" void pass_on(int number, siginfo_t* information, void*) {
  asked_to_stop = 1;
  if (information->si_code != SI_KERNEL && child > 0) kill(child, number);
}

Shared* share() {
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? nullptr : new (memory) Shared;
}

void pass_signals_on() {
  struct sigaction action = {}, before = {};
  action.sa_sigaction = pass_on;
  action.sa_flags = static_cast<int>(SA_SIGINFO | SA_RESTART);
  for (const int number : stop_signals)
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      sigaction(number, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

/// A block of SIGCHLD during its lifetime, so that the supervisor can wait for the end of a child.
class ChildSignal {
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
int wait_for_child(const ChildSignal& ended_signal, bool& out_of_time) {
  using namespace std::chrono_literals;
  constexpr double grace = 3;  // seconds; the child's own watcher ends it within one
  for (int status = 0;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return 0;
    if (shared->end.load().passed(grace) || shared->cad_end.load().passed()) {
      out_of_time = true;
      kill(child, SIGKILL);
    }
    ended_signal.wait(20ms);
  }
}

ExitCode told(ExitCode code, const std::string& message) {
  tell("collarmesh: {}\n", message);
  failed(code, message);
  return code;
}

std::string name_of(int number) {
  const char* const name = sigabbrev_np(number);
  return name == nullptr ? fmt::format("signal {}", number) : fmt::format("SIG{}", name);
}

ExitCode reason_for(int status, bool out_of_time) {
  if (const int result = shared->result.load(); result != running) return static_cast<ExitCode>(result);
  for (std::size_t at = 0; at < shared->folders_end; at += std::strlen(&shared->folders[at]) + 1)
    remove_dead_folder(&shared->folders[at]);
  if (out_of_time && shared->in_cad.load() && shared->cad_end.load().passed())
    return told(ExitCode::unreadable,
                fmt::format("{}: OpenCASCADE took too long while {}; the file is probably damaged; if it is "
                            "not, allow more time with --time-limit",
                            shared->file.data(), shared->doing.data()));
  if (out_of_time) return told(ExitCode::budget_hit, "the time limit is reached; nothing was written");
  if (!WIFSIGNALED(status)) return static_cast<ExitCode>(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  if (asked_to_stop != 0) return told(ExitCode::cancelled, "cancelled; nothing was written");
  if (number == SIGKILL)
    return told(
        ExitCode::budget_hit,
        "the program was killed, probably because the machine's memory is used up; nothing was written");
  if (number == SIGXCPU)
    return told(ExitCode::budget_hit, "the system's limit of CPU time is reached; nothing was written");
  if (shared->in_cad.load())
    return told(ExitCode::unreadable,
                fmt::format("{}: OpenCASCADE crashed while {} ({}); the file is damaged, or its shape is too "
                            "difficult for OpenCASCADE; check and repair it in the program that made it",
                            shared->file.data(), shared->doing.data(), name_of(number)));
  return told(
      ExitCode::internal_error,
      fmt::format("internal error: {}; please report it with the input and the options", name_of(number)));
}

[[noreturn]] void be_the_child(pid_t parent, const std::function<ExitCode()>& command) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) std::_Exit(static_cast<int>(ExitCode::cancelled));
  const ExitCode code = command();
  shared->result.store(static_cast<int>(code));  // keep the exit code even if unloading libraries fails
  std::exit(static_cast<int>(code));
}

}  // namespace

ExitCode run_supervised(const std::function<ExitCode()>& command) {
  shared = share();
  if (shared == nullptr) return command();
  const pid_t parent = getpid();
  const ChildSignal child_signal;
  const pid_t made = fork();
  if (made == 0) {
    child_signal.unblock();
    be_the_child(parent, command);
  }
  if (made < 0) {
    child_signal.unblock();
    shared = nullptr;
    return command();
  }
  child = made;
  pass_signals_on();
  bool out_of_time = false;
  const int status = wait_for_child(child_signal, out_of_time);
  return reason_for(status, out_of_time);
}

CadWork::CadWork(std::string_view doing, std::string_view file, double seconds) {
  if (shared == nullptr) return;
  copy(doing, shared->doing.data(), shared->doing.size());
  copy(file, shared->file.data(), shared->file.size());
  if (!shared->end.load().exists()) shared->cad_end.store(Deadline::in(seconds));
  shared->in_cad.store(true);
}

CadWork::~CadWork() {
  if (shared == nullptr) return;
  shared->in_cad.store(false);
  shared->cad_end.store({});
}

void supervise_time(Deadline deadline) {
  if (shared != nullptr) shared->end.store(deadline);
}

void supervise_folder(std::string_view folder) {
  if (shared == nullptr || folder.size() >= shared->folders.size() - shared->folders_end) return;
  copy(folder, &shared->folders[shared->folders_end], folder.size() + 1);
  shared->folders_end += folder.size() + 1;
}

}  // namespace collarmesh::process
