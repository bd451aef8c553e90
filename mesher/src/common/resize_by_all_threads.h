#pragma once

#include <cstddef>

#include "common/large_pages.h"
#include "common/parallel_for.h"

namespace collarmesh {

/// Resizes vectors. If one is large, threads of the caller's arena touch its pages first, because getting
/// pages from the system takes longer than filling them with zeros.
template <class Values, class... Others>
void resize_by_all_threads(std::size_t count, Values& values, Others&... others) {
  using Value = typename Values::value_type;
  constexpr std::size_t small_page = 4096;
  if (values.capacity() < count) reserve_in_large_pages(values, count);
  const std::size_t begin = values.size() * sizeof(Value), end = count * sizeof(Value);
  if (end > begin + 2 * large_page)
    parallel_for_ranges(end - begin, large_page, [&](std::size_t first, std::size_t last) {
      auto* const bytes = reinterpret_cast<volatile char*>(values.data()) + begin;
      for (std::size_t i = first; i < last; i += small_page) bytes[i] = 0;
    });
  values.resize(count);
  if constexpr (sizeof...(others) > 0) resize_by_all_threads(count, others...);
}

}  // namespace collarmesh
