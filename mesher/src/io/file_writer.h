#pragma once

#include <charconv>
#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "io/unfinished_file.h"

namespace collarmesh::io {

/// Writes a file that appears under its name when it is complete, or not at all. Numbers are written whatever
/// the locale, doubles in the shortest form that reads back as the same double. Throws WriteError with the
/// path and the system's reason.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  FileWriter& operator<<(std::string_view text);
  FileWriter& operator<<(char c) {
    room(1)[0] = c;
    ++used_;
    return *this;
  }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) &&
      (!std::same_as<Number, bool>)FileWriter& operator<<(Number value) {
    char* first = room(longest_number);
    used_ += static_cast<std::size_t>(std::to_chars(first, first + longest_number, value).ptr - first);
    return *this;
  }

  /// Flush, close and rename.
  void commit();

 private:
  static constexpr std::size_t buffer_bytes = 1 << 16, longest_number = 32;

  char* room(std::size_t bytes) {
    if (buffer_.size() - used_ < bytes) flush();
    return buffer_.data() + used_;
  }
  void flush();
  void write(std::string_view bytes);

  UnfinishedFile target_;
  std::FILE* file_ = nullptr;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

}  // namespace collarmesh::io
