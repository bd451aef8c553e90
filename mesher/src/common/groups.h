#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/large_pages.h"
#include "common/parallel_for.h"

namespace collarmesh {

/// Sizes for sorting items by group in two steps: chunks of items are first dealt to ranges of groups, so
/// that the remaining work fits a processor's cache.
struct Dealing {
  std::size_t chunk;   ///< number of items that one thread deals at a time
  std::size_t range;   ///< number of groups that one thread sorts at a time
  std::size_t chunks;  ///< number of chunks
  std::size_t ranges;  ///< number of ranges

  Dealing(std::size_t groups, std::size_t items)
      : chunk(parts_of(items, 8192, 64)),
        range(parts_of(groups, 1024, 1024)),
        chunks((items + chunk - 1) / chunk),
        ranges((groups + range - 1) / range) {}

 private:
  static std::size_t parts_of(std::size_t count, std::size_t least, std::size_t most_parts) {
    return std::max((count + most_parts - 1) / most_parts, least);
  }
};

/// Calls `use(group, items)` for every group that has items; group numbers are below `groups`. `visit(i,
/// give)` must call `give(group, item)` for each item of i; it is called twice for all i below `count`, and
/// must give the same both times. In each group the items are in the order of i, and those of one i in the
/// order they were given. Several threads call both functions at once. Cost: linear; memory for all items
/// once, each with a number of 32 bits.
template <class Item, class Visit, class Use>
void for_each_group(std::size_t groups, std::size_t count, const Visit& visit, const Use& use,
                    const recorded_costs::Place& place = {__builtin_FILE(), __builtin_LINE()}) {
  const Dealing dealing(groups, count);
  const std::size_t chunk = dealing.chunk, range = dealing.range, chunks = dealing.chunks,
                    ranges = dealing.ranges;
  const auto visit_chunk = [&](std::size_t c, const auto& give) {
    for (std::size_t i = c * chunk; i < std::min((c + 1) * chunk, count); ++i) visit(i, give);
  };
  struct Dealt {
    std::uint32_t group;  // within its range
    Item item;
  };
  std::vector<std::size_t> next(chunks * ranges, 0);  // slot for a chunk's next item of a range
  parallel_for(
      chunks,
      [&](std::size_t c) {
        visit_chunk(c, [&](std::size_t group, const Item&) { ++next[c * ranges + group / range]; });
      },
      place);
  std::vector<std::size_t> first(ranges + 1, 0);
  for (std::size_t r = 0, sum = 0; r < ranges; first[++r] = sum)
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::size_t items = next[c * ranges + r];
      next[c * ranges + r] = sum;
      sum += items;
    }
  const LargeBlock<Dealt> dealt(first.back());
  parallel_for(
      chunks,
      [&](std::size_t c) {
        visit_chunk(c, [&](std::size_t group, const Item& item) {
          const std::size_t r = group / range;
          dealt[next[c * ranges + r]++] = {static_cast<std::uint32_t>(group - r * range), item};
        });
      },
      place);
  parallel_for(
      ranges,
      [&](std::size_t r) {
        const std::span<const Dealt> all(&dealt[0] + first[r], first[r + 1] - first[r]);
        std::vector<std::size_t> end(range + 1, 0);
        for (const Dealt& d : all) ++end[d.group + 1];
        for (std::size_t g = 1; g <= range; ++g) end[g] += end[g - 1];
        std::vector<Item> items(all.size());
        for (const Dealt& d : all)
          items[end[d.group]++] = d.item;  // after this loop, end[g] is the end of group g
        std::size_t begin = 0;
        for (std::size_t g = 0; g < range && begin < items.size(); begin = end[g++])
          if (end[g] > begin) use(r * range + g, std::span(items).subspan(begin, end[g] - begin));
      },
      place);
}

/// Returns all i below `count`, ordered by their group `group_of(i)`, a number below `groups`; those of one
/// group ascending. Calls `group_of(i)` several times, from several threads at once. Cost: linear.
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
