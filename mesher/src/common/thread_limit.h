#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

#include "collarmesh/usable_threads.h"

namespace collarmesh {

/// A limit on the threads of parallel parts: the work that `run` calls uses at most `threads` threads, and
/// never more than there are cores or the system allows. For 0, only the latter holds.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads)
      : arena_(threads == 0   ? usable_threads()
               : threads == 1 ? 1
                              : std::min(usable_threads(), static_cast<int>(threads))) {}

  template <class Work>
  void run(const Work& work) {
    arena_.execute(work);
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace collarmesh
