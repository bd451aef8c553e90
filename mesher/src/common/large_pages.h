#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace collarmesh {

/// Large pages make random access to large arrays cheaper: fewer addresses need a walk through page tables
/// that are not in the cache.
inline constexpr std::size_t large_page = std::size_t{2} << 20U;
inline constexpr std::size_t least_bytes_in_large_pages = large_page / 2;

/// Asks the system for large pages inside this block. Correctness does not depend on the answer.
inline void prefer_large_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  if (bytes < least_bytes_in_large_pages) return;
  const auto first = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (first + large_page - 1) / large_page * large_page;
  const std::uintptr_t end = (first + bytes) / large_page * large_page;
  if (end <= begin) return;
  madvise(static_cast<char*>(block) + (begin - first), end - begin, MADV_HUGEPAGE);
#endif
}

// ThreadSanitizer does not see mremap, so after a remap it would report false races at addresses that a
// thread's stack had before.
#if defined(__linux__) && !defined(__SANITIZE_THREAD__)
#define COLLARMESH_REMAPS 1
#else
#define COLLARMESH_REMAPS 0
#endif

/// Returns whether a block of this many bytes grows without being copied.
inline bool grows_in_place([[maybe_unused]] std::size_t bytes) {
#if COLLARMESH_REMAPS
  return bytes >= least_bytes_in_large_pages;
#else
  return false;
#endif
}

/// Resizes `block`, which has `bytes` bytes (null: none yet), to `new_bytes`, and keeps the contents that
/// fit. Large blocks are remapped by the system instead of being copied. Throws std::bad_alloc.
inline void* resized_block(void* block, [[maybe_unused]] std::size_t bytes, std::size_t new_bytes) {
#if COLLARMESH_REMAPS
  const auto pages = [](std::size_t size) { return (size + large_page - 1) / large_page * large_page; };
  const bool was_mapped = bytes >= least_bytes_in_large_pages;
  if (new_bytes >= least_bytes_in_large_pages) {
    void* mapped = was_mapped ? mremap(block, pages(bytes), pages(new_bytes), MREMAP_MAYMOVE)
                              : mmap(nullptr, pages(new_bytes), PROT_READ | PROT_WRITE,
                                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    prefer_large_pages(mapped, pages(new_bytes));
    if (!was_mapped && block != nullptr) {
      std::memcpy(mapped, block, bytes);
      std::free(block);
    }
    return mapped;
  }
#endif
  void* grown = std::realloc(block, new_bytes);
  if (grown == nullptr) throw std::bad_alloc();
  return grown;
}

inline void free_block(void* block, [[maybe_unused]] std::size_t bytes) {
#if COLLARMESH_REMAPS
  if (bytes >= least_bytes_in_large_pages) {
    munmap(block, (bytes + large_page - 1) / large_page * large_page);
    return;
  }
#endif
  std::free(block);
}

/// Reserves room for this many values of a vector or string, in large pages if it is large.
template <class Values>
void reserve_in_large_pages(Values& values, std::size_t count) {
  values.reserve(count);
  prefer_large_pages(values.data(), values.capacity() * sizeof(values[0]));
}

/// Resizes a vector, in large pages if it is large.
template <class T>
void resize_in_large_pages(std::vector<T>& values, std::size_t count) {
  reserve_in_large_pages(values, count);
  values.resize(count);
}

/// An allocator that puts large blocks on large pages.
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    const bool large = count * sizeof(T) >= least_bytes_in_large_pages;
    const std::size_t bytes =
        large ? (count * sizeof(T) + large_page - 1) / large_page * large_page : count * sizeof(T);
    void* block = large ? std::aligned_alloc(large_page, bytes) : std::malloc(bytes);
    if (block == nullptr) throw std::bad_alloc();
    prefer_large_pages(block, bytes);
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t) { std::free(block); }

  friend bool operator==(const LargePageAllocator&, const LargePageAllocator&) { return true; }
};

/// A block of uninitialized values.
template <class T>
class LargeBlock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit LargeBlock(std::size_t count)
      : bytes_(count * sizeof(T)), values_(static_cast<T*>(resized_block(nullptr, 0, bytes_ + 1))) {}
  ~LargeBlock() { free_block(values_, bytes_ + 1); }
  LargeBlock(const LargeBlock&) = delete;
  LargeBlock& operator=(const LargeBlock&) = delete;

  T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::size_t bytes_;
  T* values_;
};

/// A vector for arrays as large as the mesh.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace collarmesh
