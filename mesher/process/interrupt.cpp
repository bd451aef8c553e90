#include "process/interrupt.h"

#include <fmt/format.h>
#include <sys/time.h>

#include <cmath>
#include <utility>

#include "process/process.h"

namespace collarmesh::process {

namespace {

/// Raises SIGALRM at the deadline.
void start_timer(const Deadline& deadline) {
  const double seconds = deadline.as_option();
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - std::floor(seconds)));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

bool Interrupts::is_asked() {
  const std::lock_guard lock(deadline_mutex_);
  if (deadline_.passed()) flag_.store(true, std::memory_order_relaxed);
  return flag_.load(std::memory_order_relaxed);
}

/// Returns advice that depends on the stage in which the time ran out.
std::string Interrupts::advice() const {
  const std::string stage = stage_reached().stage;
  if (stage == "start" || stage == "read")
    return "or read less at once: save the solids of a large assembly as separate files";
  if (stage == "complex")
    return "or, because many intersecting facets take the time, try another --repair-tolerance or --repair "
           "wrap";
  return "or --size for a coarser mesh; when a surface or CAD file is meshed, --repair wrap helps, too, "
         "because it ignores details that are much smaller than the size";
}

Stopped Interrupts::reason() const {
  if (signals_.load(std::memory_order_relaxed) > 0) return Cancelled();
  const std::lock_guard lock(deadline_mutex_);
  if (out_of_processor_time_.load(std::memory_order_relaxed))
    return {
        ExitCode::budget_hit,
        fmt::format(
            "the system's limit of CPU time is reached ({}); nothing was written; raise it (ulimit -t), {}",
            stage_told_, advice())};
  return {ExitCode::budget_hit,
          fmt::format("the time limit of {} s is reached ({}); nothing was written; raise --time-limit, {}",
                      time_limit_, stage_told_, advice())};
}

void Interrupts::stop_if_asked() {
  if (is_asked()) throw reason();
}

void Interrupts::set_time_limit(double seconds) {
  const std::lock_guard lock(deadline_mutex_);
  time_limit_ = seconds;
  deadline_ = Deadline::in(seconds);
  process_.supervisor.limit_time(deadline_);
  if (unwatched_ && deadline_.exists()) start_timer(deadline_);
}

double Interrupts::time_left() const {
  const std::lock_guard lock(deadline_mutex_);
  return deadline_.as_option();
}

void Interrupts::note_stage(StageReached reached, std::string told) {
  if (told.empty()) {
    told = "stage: " + reached.stage;
    if (reached.vertices > 0) told += fmt::format(", {} vertices", reached.vertices);
    if (reached.tets > 0) told += fmt::format(", {} tets", reached.tets);
  }
  {
    const std::lock_guard lock(stage_mutex_);
    std::swap(stage_, reached);
  }
  const std::lock_guard lock(deadline_mutex_);
  stage_told_ = std::move(told);
}

StageReached Interrupts::stage_reached() const {
  const std::lock_guard lock(stage_mutex_);
  return stage_;
}

}  // namespace collarmesh::process
