#pragma once

#include <algorithm>
#include <cstddef>

namespace collarmesh {

/// Sizes for sorting items by group in two steps: chunks of items are first dealt to ranges of groups, so
/// that the remaining work fits a processor's cache.
struct Dealing {
  std::size_t chunk;   ///< items dealt by one thread
  std::size_t range;   ///< groups that are sorted at once
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

}  // namespace collarmesh
