#include "io/file_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "collarmesh/error.h"

namespace collarmesh::io {

namespace {

constexpr int names_to_try = 100;

}  // namespace

FileWriter::FileWriter(std::string path) : path_(std::move(path)), buffer_(buffer_bytes) {
  errno = EEXIST;
  for (int i = 0; i < names_to_try && file_ == nullptr && errno == EEXIST; ++i) {
    temporary_ = fmt::format("{}.part{}", path_, i);
    file_ = std::fopen(temporary_.c_str(), "wbx");
  }
  if (file_ == nullptr) fail(errno);
  std::setvbuf(file_, nullptr, _IONBF, 0);
}

FileWriter::~FileWriter() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

FileWriter& FileWriter::operator<<(std::string_view text) {
  if (text.size() > buffer_.size() - used_) flush();
  if (text.size() > buffer_.size()) {
    write(text);
    return *this;
  }
  std::memcpy(buffer_.data() + used_, text.data(), text.size());
  used_ += text.size();
  return *this;
}

void FileWriter::commit() {
  flush();
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(errno);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail(error.value());
  temporary_.clear();
}

void FileWriter::flush() {
  write({buffer_.data(), used_});
  used_ = 0;
}

void FileWriter::write(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

void FileWriter::fail(int reason) const {
  throw WriteError(fmt::format("{}: cannot be written: {}", path_, std::strerror(reason)));
}

}  // namespace collarmesh::io
