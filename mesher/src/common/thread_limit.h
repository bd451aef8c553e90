#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

#include "collarmesh/usable_threads.h"

namespace collarmesh {

/// A limit on threads: the parallel parts of work that it runs use at most this many, and never more than
/// there are cores; 0: all cores, or as many threads as the system allows.
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
