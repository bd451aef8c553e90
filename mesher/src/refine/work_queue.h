#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The paper's work queue (Procedure 1). It takes priorities in order and, within a priority, the largest
/// ball first, in buckets of log2(r^2). Within a bucket it is last in, first out, which keeps the working set
/// in the cache. Obsolete entries are not removed: the caller that takes an entry compares its stamp.
class WorkQueue {
 public:
  /// The order in which work is taken; doc/architecture/refinement.md and doc/theory.md give the reasons.
  /// Refinement::run compares priorities and BlockRefinement names some: check both when the order changes.
  enum Priority : unsigned {
    encroached_subsegments,
    skinny_cells,
    coarse_subsegments,
    unresolved_points,
    unresolved_triangles,
    large_triangles,
    large_cells,
    exposed_crease_vertices,
    poor_collar_triangles,
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

  /// Makes a queue for balls up to this expected squared radius.
  explicit WorkQueue(double largest_squared_radius) : largest_exponent_(std::ilogb(largest_squared_radius)) {}

  void push(Priority priority, double squared_radius, Entry entry) {
    put(priority, bucket_of(squared_radius), entry);
  }
  unsigned bucket_of(double squared_radius) const {
    const int below = largest_exponent_ - std::ilogb(std::max(squared_radius, 1e-300));
    return static_cast<unsigned>(std::clamp(below, 0, static_cast<int>(bucket_count) - 1));
  }
  /// Puts an entry into a bucket; bucket 0 has the largest balls.
  void put(Priority priority, unsigned bucket, Entry entry) {
    assert(priority < priority_count && bucket < bucket_count);
    buckets_[priority][bucket].push_back(entry);
    first_[priority] = std::min(first_[priority], bucket);
    ++pushed_;
  }

  /// Takes the next entry: largest ball of the first nonempty priority. Returns false if the queue is empty.
  bool pop(Item& item) {
    for (unsigned priority = 0; priority < priority_count; ++priority)
      if (const unsigned bucket = first_bucket(static_cast<Priority>(priority)); bucket < bucket_count) {
        auto& entries = buckets_[priority][bucket];
        item = {static_cast<Priority>(priority), entries.back()};
        entries.pop_back();
        return true;
      }
    return false;
  }

  /// Returns the priority of the next entry; `priority_count` if there is none.
  Priority first_priority() {
    unsigned priority = 0;
    while (priority < priority_count && first_bucket(static_cast<Priority>(priority)) == bucket_count)
      ++priority;
    return static_cast<Priority>(priority);
  }
  /// Returns the bucket of the next entry of a priority; `bucket_count` if there is none.
  unsigned first_bucket(Priority priority) {
    unsigned& bucket = first_[priority];
    while (bucket < bucket_count && buckets_[priority][bucket].empty()) ++bucket;
    return bucket;
  }
  /// Returns whether any entry of a priority is still due. Until it finds one, drops entries that are not.
  template <class IsDue>
  bool any_due(Priority priority, const IsDue& is_due) {
    for (unsigned bucket = first_bucket(priority); bucket < bucket_count; bucket = first_bucket(priority)) {
      auto& entries = buckets_[priority][bucket];
      while (!entries.empty() && !is_due(entries.back())) entries.pop_back();
      if (!entries.empty()) return true;
    }
    return false;
  }
  std::size_t count(Priority priority, unsigned bucket) const { return buckets_[priority][bucket].size(); }
  /// Takes all entries of a bucket.
  std::vector<Entry> take(Priority priority, unsigned bucket) {
    return std::exchange(buckets_[priority][bucket], {});
  }

  static constexpr unsigned bucket_count = 192;

  /// Returns the number of entries pushed so far.
  std::size_t pushed() const { return pushed_; }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& priority : buckets_)
      for (const auto& bucket : priority) sum += bucket.capacity() * sizeof(Entry);
    return sum;
  }

 private:
  int largest_exponent_;
  std::array<std::array<std::vector<Entry>, bucket_count>, priority_count> buckets_;
  std::array<unsigned, priority_count> first_{};
  std::size_t pushed_ = 0;
};

}  // namespace collarmesh
