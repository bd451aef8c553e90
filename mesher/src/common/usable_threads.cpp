#include "collarmesh/usable_threads.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <latch>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "common/parallel_for.h"
#include "common/recorded_costs.h"

namespace collarmesh {

namespace {

/// Returns how many threads there can be at once, including this one, up to `most`.
int count_threads(int most) {
  std::latch counted(1);
  std::vector<std::jthread> threads;  // joined before the latch ends
  threads.reserve(static_cast<std::size_t>(most));
  try {
    while (static_cast<int>(threads.size()) + 1 < most) threads.emplace_back([&counted] { counted.wait(); });
  } catch (const std::system_error&) {
    // The system allows no more threads than these.
  }
  counted.count_down();
  return static_cast<int>(threads.size()) + 1;
}

/// Returns whether TBB could create its threads; it creates them when there is work.
bool tbb_has_its_threads(int threads) {
  constexpr std::size_t pieces = 256;
  try {
    tbb::task_arena arena(threads);
    arena.execute([] { parallel_for(pieces, [](std::size_t) { std::this_thread::yield(); }); });
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

/// Returns the number of cores to use: `there`, or COLLARMESH_CORES in the environment, for tests on small
/// machines.
int cores_to_use(int there) {
  constexpr int most = 1024;
  const char* const wanted = std::getenv("COLLARMESH_CORES");
  return wanted == nullptr ? there : std::clamp(std::atoi(wanted), 1, most);
}

class Threads {
 public:
  Threads() {
    const int there = tbb::info::default_concurrency(), cores = cores_to_use(there);
    if (recorded_costs::on) {
      count_ = cores;
      keep_to(cores);
      return;
    }
    count_ = count_threads(cores);
    if (count_ < cores || cores > there) keep_to(count_);
    if (count_ == 1 || tbb_has_its_threads(count_)) return;
    count_ = 1;
    keep_to(count_);
  }
  int count() const { return count_; }

 private:
  void keep_to(int threads) {
    limit_.reset();
    limit_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                   static_cast<std::size_t>(threads));
  }

  int count_ = 1;
  std::unique_ptr<tbb::global_control> limit_;
};

}  // namespace

int usable_threads() {
  static const Threads threads;
  return threads.count();
}

}  // namespace collarmesh
