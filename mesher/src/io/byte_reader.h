#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "collarmesh/error.h"

namespace collarmesh::io {

/// The types of numbers in files.
enum class NumberType { unknown, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
constexpr std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 11> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// Returns a number from its bytes in this order.
template <class Number>
Number value_at(std::string_view bytes, std::size_t at, std::endian order) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data() + at, sizeof(Number));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}
/// Returns the bytes of a number in this order.
template <class Number>
std::array<char, sizeof(Number)> bytes_of(Number value, std::endian order) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Reads plain values of either byte order from memory and knows its position. Every failure is a ReadError
/// "PATH: byte N: ...".
class ByteReader {
 public:
  /// `first_byte` is the position of `bytes` in the file. Precondition: `path` and `bytes` outlive the
  /// reader.
  ByteReader(const std::string& path, std::string_view bytes, std::endian order = std::endian::little,
             std::size_t first_byte = 0)
      : path_(path), bytes_(bytes), order_(order), first_byte_(first_byte) {}

  template <class T>
  T get(std::string_view what) {
    static_assert(std::is_arithmetic_v<T>);
    if (left() < sizeof(T))
      fail(
          fmt::format("expected {} ({} bytes), found the end of the file after {}", what, sizeof(T), left()));
    at_ += sizeof(T);
    return value_at<T>(bytes_, at_ - sizeof(T), order_);
  }

  void skip(std::size_t count, std::string_view what) {
    if (left() < count)
      fail(fmt::format("expected {} ({} bytes), found the end of the file after {}", what, count, left()));
    at_ += count;
  }

  std::size_t offset() const { return first_byte_ + at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  std::string_view rest() const { return bytes_.substr(at_); }

  [[noreturn]] void fail(const std::string& message) const {
    throw ReadError(fmt::format("{}: byte {}: {}", path_, offset(), message));
  }

 private:
  const std::string& path_;
  std::string_view bytes_;
  std::endian order_;
  std::size_t first_byte_;
  std::size_t at_ = 0;
};

}  // namespace collarmesh::io
