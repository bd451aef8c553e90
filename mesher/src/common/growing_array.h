#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

#include "common/large_pages.h"

namespace collarmesh {

/// A vector of plain data that grows in place where possible: the system remaps large blocks instead of
/// copying them, so growth never holds two copies in memory.
template <class T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  GrowingArray() = default;
  GrowingArray(const GrowingArray&) = delete;
  GrowingArray& operator=(const GrowingArray&) = delete;
  ~GrowingArray() { free_block(data_, capacity_ * sizeof(T)); }

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
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
    if (size_ == capacity_) reserve(with_room_to_grow(size_));
    data_[size_++] = copy;
  }
  void resize(std::size_t n, const T& value = T()) {
    const T copy = value;
    if (n > capacity_) reserve(with_room_to_grow(n));
    for (; size_ < n; ++size_) data_[size_] = copy;
    size_ = n;
  }

  /// Grows without initializing the new entries.
  void extend(std::size_t n) {
    if (n > capacity_) reserve(with_room_to_grow(n));
    size_ = n;
  }

 private:
  // Returns the capacity to reserve: a block that grows without a copy needs little extra room.
  static std::size_t with_room_to_grow(std::size_t n) {
    return n + n / (grows_in_place(n * sizeof(T)) ? 8 : 2) + 64;
  }
  void reserve(std::size_t n) {
    data_ = static_cast<T*>(resized_block(data_, capacity_ * sizeof(T), n * sizeof(T)));
    capacity_ = n;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace collarmesh
