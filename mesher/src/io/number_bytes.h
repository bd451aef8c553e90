#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace collarmesh::io {

/// The types of numbers in files.
enum class NumberType { unknown, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
constexpr std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 11> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// Returns the number whose bytes, in this byte order, begin at `at`.
template <class Number>
Number value_at(std::string_view bytes, std::size_t at, std::endian order) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data() + at, sizeof(Number));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}
/// Returns the bytes of a number in this byte order.
template <class Number>
std::array<char, sizeof(Number)> bytes_of(Number value, std::endian order) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

}  // namespace collarmesh::io
