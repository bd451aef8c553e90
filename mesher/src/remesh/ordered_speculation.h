#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/parallel_for.h"
#include "remesh/change_times.h"

namespace collarmesh::remeshing {

/// A parallel loop that makes changes in a fixed order: all threads propose changes for the next few items;
/// then one thread makes these changes, one after the other. `Proposer` finds changes and only reads the
/// mesh; each thread has its own.
template <class Proposer>
class OrderedSpeculation {
 public:
  /// Makes each proposer by calling `make()`.
  template <class Make>
  explicit OrderedSpeculation(const Make& make) : own_(make()), proposers_(make) {}

  /// Returns the proposer of the thread that makes the changes.
  Proposer& own() { return own_; }

  /// Calls `propose(proposer, item, proposal)` for all items, by all threads.
  void propose_all(const auto& items, auto& proposals, const auto& propose) {
    parallel_for(items.size(), [&](std::size_t i) { propose(proposers_.local(), items[i], proposals[i]); });
  }

  /// For one item after the other, calls `propose(proposer, item, proposal)` and then `use(item, proposal)`,
  /// which may change the mesh. All threads propose ahead for the next items. Before its use, a proposal is
  /// made anew unless `is_up_to_date(item, proposal, begun)` returns true, which means that nothing on which
  /// it depends has changed since the time `begun`. So the result does not depend on the number of threads.
  /// Ends and returns false as soon as `use` returns false; otherwise returns true.
  template <class Proposal>
  bool for_each(const auto& items, ChangeTimes& times, const auto& propose, const auto& is_up_to_date,
                const auto& use) {
    const std::size_t at_once = proposals_at_once(items.size());
    std::vector<Proposal> proposals(at_once);
    for (std::size_t first = 0; first < items.size(); first += at_once) {
      const auto next = std::span(items).subspan(first, std::min(at_once, items.size() - first));
      const std::uint32_t begun = times.advance();
      if (at_once > 1) propose_all(next, proposals, propose);
      for (std::size_t i = 0; i < next.size(); ++i) {
        if (at_once == 1 || !is_up_to_date(next[i], proposals[i], begun))
          propose(own_, next[i], proposals[i]);
        if (!use(next[i], proposals[i])) return false;
      }
    }
    return true;
  }

 private:
  // Returns the number of items for which changes are proposed at once: one in `items_per_proposal` of all
  // items, so that proposals rarely concern the same tets; but at least `proposals_per_thread` for each
  // thread, and at most `most`. A single thread proposes changes for one item at a time.
  static std::size_t proposals_at_once(std::size_t items) {
    constexpr std::size_t most = 256, items_per_proposal = 256, proposals_per_thread = 4;
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    if (threads == 1) return 1;
    return std::min(most, std::max(items / items_per_proposal, proposals_per_thread * threads));
  }

  Proposer own_;
  tbb::enumerable_thread_specific<Proposer> proposers_;
};

}  // namespace collarmesh::remeshing
