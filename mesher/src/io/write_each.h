#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <vector>

#include "common/parallel_for.h"
#include "io/file_writer.h"

namespace collarmesh::io {

/// Calls `write(text, i)` to write item i to a TextBuffer, for all i below `count`. Several threads call
/// `write` at once, each for consecutive items; in the file the items are in order. One thread passes
/// formatted text to the system while the others format the next items.
template <class Write>
void write_each(FileWriter& out, std::size_t count, const Write& write) {
  constexpr std::size_t at_once = 1024, buffers_of_a_thread = 8;
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t buffers = threads > 1 ? threads * buffers_of_a_thread : 1;
  std::array<std::vector<TextBuffer>, 2> texts{std::vector<TextBuffer>(buffers),
                                               std::vector<TextBuffer>(buffers)};
  std::size_t formatted = 0;  // bytes in the buffers of the previous round
  for (std::size_t first = 0, round = 0; first < count || formatted > 0; ++round) {
    std::vector<TextBuffer>&now = texts[round % 2], &before = texts[(round + 1) % 2];
    const std::size_t items = std::min(at_once * buffers, count - first);
    const std::size_t pieces = (items + at_once - 1) / at_once;
    parallel_for(pieces + 1, [&](std::size_t piece) {
      if (piece == 0) {
        for (std::size_t i = 0; i < formatted; ++i) out.append(before[i].text());
        return;
      }
      TextBuffer& text = now[piece - 1];
      text.clear();
      const std::size_t begin = first + (piece - 1) * at_once;
      for (std::size_t i = begin; i < std::min(begin + at_once, first + items); ++i) write(text, i);
    });
    formatted = pieces;
    first += items;
  }
}

}  // namespace collarmesh::io
