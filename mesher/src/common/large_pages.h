#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace collarmesh {

/// Large arrays that are visited in no particular order cost less when the system keeps them in large pages:
/// an address is found without a walk through page tables that are themselves not in the cache.
inline constexpr std::size_t large_page = std::size_t{2} << 20U;
inline constexpr std::size_t least_bytes_in_large_pages = 2 * large_page;

/// Ask the system for large pages inside this block. Only a wish: nothing depends on it.
inline void prefer_large_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  if (bytes < least_bytes_in_large_pages) return;
  const auto first = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (first + large_page - 1) / large_page * large_page;
  const std::uintptr_t end = (first + bytes) / large_page * large_page;
  madvise(static_cast<char*>(block) + (begin - first), end - begin, MADV_HUGEPAGE);
#endif
}

/// Gives large blocks large pages.
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* block = bytes < least_bytes_in_large_pages
                      ? std::malloc(bytes)
                      : std::aligned_alloc(large_page, (bytes + large_page - 1) / large_page * large_page);
    if (block == nullptr) throw std::bad_alloc();
    prefer_large_pages(block, bytes);
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t) { std::free(block); }

  friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) { return true; }
};

/// A vector for arrays as large as the mesh.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace collarmesh
