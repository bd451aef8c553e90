#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#include "common/recorded_costs.h"

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#include <vector>
#endif

namespace collarmesh {

/// Calls `work(i)` for all i below `count`, by the threads of the caller's arena. Returns when all are
/// done. With GCC's ThreadSanitizer `work` must not throw.
template <class Work>
void parallel_for(std::size_t count, const Work& work,
                  const recorded_costs::Place& place = {__builtin_FILE(), __builtin_LINE()}) {
  if (recorded_costs::on) return recorded_costs::run(count, work, place);
#ifdef __SANITIZE_THREAD__
  // ThreadSanitizer cannot see how TBB synchronizes threads, because TBB's library is not instrumented; so
  // these builds use plain threads, the same number on every machine.
  constexpr int threads = 8;
  std::atomic<std::size_t> next{0};
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(take_turns);
  take_turns();
#else
  tbb::parallel_for(std::size_t{0}, count, work);
#endif
}

/// Calls `work(first, last)` for consecutive ranges of all numbers below `count`. Ranges have this length;
/// the last one may be shorter.
template <class Work>
void parallel_for_ranges(std::size_t count, std::size_t length, const Work& work,
                         const recorded_costs::Place& place = {__builtin_FILE(), __builtin_LINE()}) {
  parallel_for((count + length - 1) / length,
               [&](std::size_t i) { work(i * length, std::min((i + 1) * length, count)); }, place);
}

/// Calls `work(i)` for all i below `count`, like `parallel_for`, but each thread takes thousands of calls at
/// a time. For calls that take little time.
template <class Work>
void parallel_for_in_chunks(std::size_t count, const Work& work,
                            const recorded_costs::Place& place = {__builtin_FILE(), __builtin_LINE()}) {
  constexpr std::size_t at_once = 4096;
  const auto work_on_all = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) work(i);
  };
  parallel_for_ranges(count, at_once, work_on_all, place);
}

}  // namespace collarmesh
