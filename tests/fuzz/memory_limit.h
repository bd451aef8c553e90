#pragma once

#include <sanitizer/allocator_interface.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace collarmesh::testing {

/// Aborts if more than `bytes` are allocated at a time during its lifetime, in the allocation that exceeds
/// them. Only one object may exist at a time. Needs a sanitizer's allocator.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t bytes) {
    static const bool installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
    if (!installed) std::abort();
    live_ = 0;
    limit_ = static_cast<std::int64_t>(bytes);
  }
  ~MemoryLimit() { limit_ = unlimited; }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  static constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();

  static void on_malloc(const volatile void*, std::size_t size) {
    live_ += static_cast<std::int64_t>(size);
    if (live_ <= limit_) return;
    limit_ = unlimited;
    constexpr std::string_view message = "More memory than the size of the input allows.\n";
    if (write(STDERR_FILENO, message.data(), message.size()) >= 0) std::abort();
  }
  /// Freeing earlier allocations makes `live_` smaller, which does not matter here.
  static void on_free(const volatile void* memory) {
    live_ -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
  }

  inline static std::int64_t live_ = 0, limit_ = unlimited;
};

}  // namespace collarmesh::testing
