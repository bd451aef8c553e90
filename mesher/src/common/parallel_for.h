#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace collarmesh {

/// `work(i)` for all i below `count`, by the threads of the arena that runs the caller. Returns when all are
/// done. ThreadSanitizer is told that what was before the loop happens before each `work(i)` and each of these
/// before what comes after it: TBB's library is not built with it, so its own synchronization is not seen.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
#ifdef __SANITIZE_THREAD__
  char begin = 0, end = 0;
  __tsan_release(&begin);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    __tsan_acquire(&begin);
    work(i);
    __tsan_release(&end);
  });
  __tsan_acquire(&end);
#else
  tbb::parallel_for(std::size_t{0}, count, work);
#endif
}

}  // namespace collarmesh
