#pragma once

#include <bit>
#include <cstdio>
#include <string>
#include <string_view>

#include "io/number_bytes.h"
#include "io/text_buffer.h"
#include "io/unfinished_file.h"

namespace collarmesh::io {

/// A writer of a file that appears under its name when it is complete, or not at all. Throws WriteError with
/// the path and the system's reason.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// Appends a value in the format of TextBuffer.
  template <class Value>
  FileWriter& operator<<(const Value& value) {
    buffer_ << value;
    if (buffer_.text().size() >= most_buffered) flush();
    return *this;
  }

  /// Appends text as it is; long text without a copy.
  void append(std::string_view text);
  /// Appends the bytes of a number in this byte order.
  template <class Number>
  void append_bytes(Number value, std::endian order) {
    const auto bytes = bytes_of(value, order);
    *this << std::string_view(bytes.data(), bytes.size());
  }
  /// Flushes, closes and renames the file.
  void commit();

 private:
  static constexpr std::size_t most_buffered = 1 << 16;

  void flush();
  void write(std::string_view text);

  UnfinishedFile target_;
  std::FILE* file_ = nullptr;
  TextBuffer buffer_;
};

}  // namespace collarmesh::io
