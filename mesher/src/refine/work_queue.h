#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The paper's work queue (Procedure 1): priorities, and inside a priority the
/// largest ball first, in buckets of log2(r^2), last in first out inside a bucket, which keeps the
/// working set in the cache. Entries are never removed early: whoever takes one compares its stamp.
/// Subsegments wait for skinny cells that are far larger: two curves very close to each other would be cut
/// into all their pieces in a coarse mesh otherwise, whose stars then have so many cells, all of which each
/// insertion nearby replaces.
class WorkQueue {
 public:
  enum Priority : unsigned {
    encroached_subsegments,
    ends_of_encroached_subsegments,  ///< unresolved ends of a curve's first subsegments
    skinny_cells,
    unresolved_points,
    unresolved_triangles,
    large_triangles,
    large_cells,
    priority_count
  };
  struct Entry {
    Index id;
    std::uint32_t stamp;
  };
  struct Item {
    Priority priority;
    Entry entry;
  };

  /// Balls are compared with this squared radius, the largest to be expected.
  explicit WorkQueue(double largest_squared_radius)
      : largest_exponent_(std::ilogb(largest_squared_radius)) {}

  void push(Priority priority, double squared_radius, Entry entry) {
    const int below = largest_exponent_ - std::ilogb(std::max(squared_radius, 1e-300));
    const auto bucket = static_cast<unsigned>(std::clamp(below, 0, static_cast<int>(bucket_count) - 1));
    buckets_[priority][bucket].push_back(entry);
    first_[priority] = std::min(first_[priority], bucket);
    ++pushed_;
  }

  /// Take the next entry: largest ball of the first priority that has any. False when empty.
  bool pop(Item& item) {
    for (unsigned priority = 0; priority < priority_count; ++priority) {
      const unsigned bucket = first_bucket(priority);
      if (bucket == bucket_count) continue;
      if (priority == encroached_subsegments && first_bucket(skinny_cells) + far_larger <= bucket)
        priority = skinny_cells;
      auto& entries = buckets_[priority][first_[priority]];
      item = {static_cast<Priority>(priority), entries.back()};
      entries.pop_back();
      return true;
    }
    return false;
  }

  /// Entries pushed so far.
  std::size_t pushed() const { return pushed_; }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& priority : buckets_)
      for (const auto& bucket : priority) sum += bucket.capacity() * sizeof(Entry);
    return sum;
  }

 private:
  static constexpr unsigned bucket_count = 192;
  static constexpr unsigned far_larger = 20;  // buckets: a radius 1024 times as large

  /// The first one that holds something, their number if none does.
  unsigned first_bucket(unsigned priority) {
    unsigned& bucket = first_[priority];
    while (bucket < bucket_count && buckets_[priority][bucket].empty()) ++bucket;
    return bucket;
  }

  int largest_exponent_;
  std::array<std::array<std::vector<Entry>, bucket_count>, priority_count> buckets_;
  std::array<unsigned, priority_count> first_{};
  std::size_t pushed_ = 0;
};

}  // namespace collarmesh
