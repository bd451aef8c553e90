#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "io/text_buffer.h"
#include "io/unfinished_file.h"

namespace collarmesh::io {

/// Writes a text file that appears under its name when it is complete, or not at all. Throws WriteError with
/// the path and the system's reason.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// As TextBuffer.
  template <class Value>
  FileWriter& operator<<(const Value& value) {
    buffer_ << value;
    if (buffer_.text().size() >= most_buffered) flush();
    return *this;
  }

  /// Appends text as it is, without a copy where it is long.
  void append(std::string_view text);
  /// Flush, close and rename.
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
