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
class WorkQueue {
 public:
  enum Priority : unsigned {
    encroached_subsegments,
    ends_of_encroached_subsegments,  ///< unresolved ends of a curve's first subsegments
    skinny_cells,
    coarse_subsegments,
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
      unsigned& bucket = first_[priority];
      for (; bucket < bucket_count; ++bucket) {
        auto& entries = buckets_[priority][bucket];
        if (entries.empty()) continue;
        item = {static_cast<Priority>(priority), entries.back()};
        entries.pop_back();
        return true;
      }
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
  int largest_exponent_;
  std::array<std::array<std::vector<Entry>, bucket_count>, priority_count> buckets_;
  std::array<unsigned, priority_count> first_{};
  std::size_t pushed_ = 0;
};

}  // namespace collarmesh
