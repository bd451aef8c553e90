#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/sort_uniquely.h"
#include "remesh/change_times.h"

namespace collarmesh::remeshing::coarsening {

/// A record of vertices for which every collapse with repairs failed. Each has a list of the vertices whose
/// tets its trials examined: as long as no tet there changes, the trials would fail again in the same way.
class FailedRepairs {
 public:
  /// Records that all collapses of a vertex failed at the time `now`, after examining the tets at the
  /// vertices `looked_at`.
  void note(Index vertex, std::vector<Index> looked_at, std::uint32_t now) {
    sort_uniquely(looked_at);
    failures_.insert_or_assign(vertex, Failure{now, std::move(looked_at)});
  }

  /// Returns the vertices whose tets the failed trials of `vertex` examined, if none of these vertices has
  /// changed since. Returns an empty list otherwise, and for a vertex without a record.
  std::span<const Index> still_fails(Index vertex, const ChangeTimes& changes) const {
    const auto found = failures_.find(vertex);
    if (found == failures_.end()) return {};
    const Failure& failure = found->second;
    if (changes.any_after(failure.when, failure.looked_at)) return {};
    return failure.looked_at;
  }

 private:
  struct Failure {
    std::uint32_t when;
    std::vector<Index> looked_at;
  };
  std::unordered_map<Index, Failure> failures_;
};

}  // namespace collarmesh::remeshing::coarsening
