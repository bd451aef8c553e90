#include "io/file_writer.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace collarmesh::io {

FileWriter::FileWriter(std::string path)
    : target_(std::move(path)), file_(std::fopen(target_.temporary().c_str(), "wb")), buffer_(buffer_bytes) {
  if (file_ == nullptr) target_.fail(errno);
  std::setvbuf(file_, nullptr, _IONBF, 0);
}

FileWriter::~FileWriter() {
  if (file_ != nullptr) std::fclose(file_);
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
  if (std::fclose(std::exchange(file_, nullptr)) != 0) target_.fail(errno);
  target_.commit();
}

void FileWriter::flush() {
  write({buffer_.data(), used_});
  used_ = 0;
}

void FileWriter::write(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) target_.fail(errno);
}

}  // namespace collarmesh::io
