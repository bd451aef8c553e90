#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/sort_uniquely.h"
#include "remesh/change_times.h"

namespace collarmesh::remeshing::coarsening {

/// A record of vertices whose collapses could not be repaired, and of the data that these trials depended on.
/// As long as none of this data changes, the trials would fail again in the same way.
class FailedRepairs {
 public:
  /// Records that all collapses of a vertex failed at this time, and the vertices whose tets they examined.
  void note(Index vertex, std::vector<Index> looked_at, std::uint32_t now) {
    sort_uniquely(looked_at);
    failures_.insert_or_assign(vertex, Failure{now, std::move(looked_at)});
  }

  /// Returns the vertices whose tets the failed trials examined, if nothing has changed there since.
  /// Otherwise, and for a vertex without a record, returns none.
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
