#include "io/file_writer.h"

#include <cerrno>
#include <utility>

namespace collarmesh::io {

FileWriter::FileWriter(std::string path)
    : target_(std::move(path)), file_(std::fopen(target_.temporary().c_str(), "wb")) {
  if (file_ == nullptr) target_.fail(errno);
  std::setvbuf(file_, nullptr, _IONBF, 0);
}

FileWriter::~FileWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void FileWriter::commit() {
  flush();
  if (std::fclose(std::exchange(file_, nullptr)) != 0) target_.fail(errno);
  target_.commit();
}

void FileWriter::append(std::string_view text) {
  if (text.size() < most_buffered / 2) {
    *this << text;
    return;
  }
  flush();
  write(text);
}

void FileWriter::flush() {
  write(buffer_.text());
  buffer_.clear();
}

void FileWriter::write(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) target_.fail(errno);
}

}  // namespace collarmesh::io
