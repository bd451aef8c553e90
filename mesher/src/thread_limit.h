#pragma once

#include <tbb/task_arena.h>

namespace collarmesh {

/// Runs work whose parallel parts use so many threads at most; 0: as many as there are cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)) {}

  template <class Work>
  void run(const Work& work) {
    arena_.execute(work);
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace collarmesh
