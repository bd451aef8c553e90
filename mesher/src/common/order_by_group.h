#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/dealing.h"
#include "common/large_pages.h"
#include "common/parallel_for.h"

namespace collarmesh {

/// Returns all numbers below `count` ordered by group (numbers below `groups`), and within a group in their
/// own order. Calls `group_of(i)` several times, from several threads at once. Cost: linear.
template <class GroupOf>
std::vector<Index> order_by_group(std::size_t groups, std::size_t count, const GroupOf& group_of,
                                  const recorded_costs::Place& place = {__builtin_FILE(), __builtin_LINE()}) {
  const Dealing dealing(groups, count);
  const std::size_t chunk = dealing.chunk, range = dealing.range, chunks = dealing.chunks,
                    ranges = dealing.ranges;
  std::vector<Index> next(chunks * ranges, 0);  // slot for a chunk's next item of a range
  std::vector<Index> first(ranges + 1, 0);
  parallel_for_ranges(
      count, chunk,
      [&](std::size_t begin, std::size_t end) {
        Index* const counts = next.data() + begin / chunk * ranges;
        for (std::size_t i = begin; i < end; ++i) ++counts[group_of(i) / range];
      },
      place);
  Index sum = 0;
  for (std::size_t r = 0; r < ranges; first[++r] = sum)
    for (std::size_t c = 0; c < chunks; ++c) sum += std::exchange(next[c * ranges + r], sum);
  struct Dealt {
    Index group, item;
  };
  const LargeBlock<Dealt> dealt(count);
  parallel_for_ranges(
      count, chunk,
      [&](std::size_t begin, std::size_t end) {
        Index* const places = next.data() + begin / chunk * ranges;
        for (std::size_t i = begin; i < end; ++i) {
          const auto group = static_cast<Index>(group_of(i));
          dealt[places[group / range]++] = {group, static_cast<Index>(i)};
        }
      },
      place);
  std::vector<Index> order;
  resize_in_large_pages(order, count);
  parallel_for(
      ranges,
      [&](std::size_t r) {
        std::vector<Index> places(range + 1, 0);
        for (Index d = first[r]; d < first[r + 1]; ++d) ++places[dealt[d].group - r * range + 1];
        places[0] = first[r];
        for (std::size_t g = 1; g <= range; ++g) places[g] += places[g - 1];
        for (Index d = first[r]; d < first[r + 1]; ++d)
          order[places[dealt[d].group - r * range]++] = dealt[d].item;
      },
      place);
  return order;
}

}  // namespace collarmesh
