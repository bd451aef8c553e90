#include "io/file_bytes.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "collarmesh/error.h"
#include "common/lower_case.h"

namespace collarmesh::io {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void fail(const std::string& path) {
  throw ReadError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
}

}  // namespace

std::string read_bytes(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) throw ReadError(path + ": is a folder; name a file in it");
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path);
  std::string bytes;
  const std::uintmax_t size =
      std::filesystem::is_regular_file(status) ? std::filesystem::file_size(path, error) : 0;
  if (!error && size > 0) {
    bytes.resize(size);
    bytes.resize(std::fread(bytes.data(), 1, size, file.get()));
  }
  std::array<char, 65536> block;
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get()))
    bytes.append(block.data(), got);
  if (std::ferror(file.get())) fail(path);
  return bytes;
}

std::string format_of(const std::string& path, std::string_view format) {
  return lower_case(format.empty() ? std::filesystem::path(path).extension().string() : format);
}

}  // namespace collarmesh::io
