#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include "common/large_pages.h"

namespace collarmesh {

/// A vector of plain data that grows in place where it can: large blocks are remapped by the system instead
/// of being copied, so growth never holds two copies in memory.
template <class T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  GrowingArray() = default;
  GrowingArray(const GrowingArray&) = delete;
  GrowingArray& operator=(const GrowingArray&) = delete;
  ~GrowingArray() { free_block(data_, capacity_ * sizeof(T)); }

  std::size_t size() const { return size_; }
  /// Of memory. What large arrays have not used yet takes none: the system gives pages when they are used.
  std::size_t bytes() const {
    const std::size_t used = (size_ * sizeof(T) + large_page - 1) / large_page * large_page;
    return std::min(capacity_ * sizeof(T), used);
  }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) {
    assert(i < size_);
    return data_[i];
  }
  const T& operator[](std::size_t i) const {
    assert(i < size_);
    return data_[i];
  }

  void push_back(const T& value) {
    const T copy = value;
    if (size_ == capacity_) reserve(size_ + size_ / 2 + 64);
    data_[size_++] = copy;
  }
  void append(std::span<const T> values) {
    const std::size_t before = size_;
    extend(size_ + values.size());
    std::copy(values.begin(), values.end(), data_ + before);
  }
  void resize(std::size_t n, const T& value = T()) {
    const T copy = value;
    if (n > capacity_) reserve(n + n / 2 + 64);
    for (; size_ < n; ++size_) data_[size_] = copy;
    size_ = n;
  }

  /// Grow without setting what is new.
  void extend(std::size_t n) {
    if (n > capacity_) reserve(n + n / 2 + 64);
    size_ = n;
  }

 private:
  void reserve(std::size_t n) {
    data_ = static_cast<T*>(resized_block(data_, capacity_ * sizeof(T), n * sizeof(T)));
    capacity_ = n;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace collarmesh
