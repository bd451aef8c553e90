#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace collarmesh {

/// Runs work whose parallel parts use so many threads at most, and never more than there are cores; 0: as
/// many as there are.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads)
      : arena_(threads == 0 ? cores() : std::min(cores(), static_cast<int>(threads))) {}

  template <class Work>
  void run(const Work& work) {
    arena_.execute(work);
  }

 private:
  static int cores() { return tbb::info::default_concurrency(); }

  tbb::task_arena arena_;
};

}  // namespace collarmesh
