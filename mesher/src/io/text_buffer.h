#pragma once

#include <charconv>
#include <concepts>
#include <cstring>
#include <string_view>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::io {

/// Text in memory. Numbers are written whatever the locale, doubles in the shortest form that reads back as
/// the same double.
class TextBuffer {
 public:
  TextBuffer& operator<<(std::string_view text) {
    std::memcpy(room(text.size()), text.data(), text.size());
    used_ += text.size();
    return *this;
  }
  TextBuffer& operator<<(char c) {
    room(1)[0] = c;
    ++used_;
    return *this;
  }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) &&
      (!std::same_as<Number, bool>)TextBuffer& operator<<(Number value) {
    char* first = room(longest_number);
    used_ += static_cast<std::size_t>(std::to_chars(first, first + longest_number, value).ptr - first);
    return *this;
  }

  TextBuffer& operator<<(const Point& p) { return *this << p.x << ' ' << p.y << ' ' << p.z; }

  std::string_view text() const { return {bytes_.data(), used_}; }
  void clear() { used_ = 0; }

 private:
  static constexpr std::size_t longest_number = 32, least_bytes = 1 << 16;

  char* room(std::size_t bytes) {
    if (bytes_.size() - used_ < bytes) bytes_.resize(2 * bytes_.size() + bytes + least_bytes);
    return bytes_.data() + used_;
  }

  std::vector<char> bytes_;
  std::size_t used_ = 0;
};

}  // namespace collarmesh::io
