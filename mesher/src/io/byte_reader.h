#pragma once

#include <fmt/format.h>

#include <bit>
#include <string>
#include <string_view>
#include <type_traits>

#include "collarmesh/error.h"
#include "io/number_bytes.h"

namespace collarmesh::io {

/// A reader of plain values, in either byte order, from memory. It knows its position. Every failure is a
/// ReadError "PATH: byte N: ...".
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
      fail(fmt::format("expected {} ({} bytes), found the end of the file after {} of them", what, sizeof(T),
                       left()));
    at_ += sizeof(T);
    return value_at<T>(bytes_, at_ - sizeof(T), order_);
  }

  void skip(std::size_t count, std::string_view what) {
    if (left() < count)
      fail(fmt::format("expected {} ({} bytes), found the end of the file after {} of them", what, count,
                       left()));
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
