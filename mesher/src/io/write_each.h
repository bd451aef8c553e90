#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

#include "common/parallel_for.h"
#include "io/file_writer.h"

namespace collarmesh::io {

/// `write(text, i)` writes item i to a TextBuffer, for all i below `count`: several threads at once, each
/// some items that follow each other. The file has them in their order.
template <class Write>
void write_each(FileWriter& out, std::size_t count, const Write& write) {
  constexpr std::size_t at_once = 1024, buffers_of_a_thread = 8;
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  std::vector<TextBuffer> texts(threads > 1 ? threads * buffers_of_a_thread : 1);
  for (std::size_t first = 0; first < count; first += at_once * texts.size()) {
    const std::size_t items = std::min(at_once * texts.size(), count - first);
    parallel_for_ranges(items, at_once, [&](std::size_t begin, std::size_t end) {
      TextBuffer& text = texts[begin / at_once];
      text.clear();
      for (std::size_t i = begin; i < end; ++i) write(text, first + i);
    });
    for (std::size_t i = 0; i * at_once < items; ++i) out << texts[i].text();
  }
}

}  // namespace collarmesh::io
