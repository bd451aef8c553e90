#include "io/unfinished_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "collarmesh/error.h"

namespace collarmesh::io {

namespace {

constexpr int names_to_try = 100;

/// Gives a temporary file the mode of the file at `path`, if there is one, and flushes it to the disk.
/// Returns the system's error number, 0: none. EINVAL and ENOTSUP mean that the file system cannot flush.
int settle(const std::string& temporary, const std::string& path) {
  struct stat before = {};
  if (stat(path.c_str(), &before) == 0 && chmod(temporary.c_str(), before.st_mode & 07777) != 0) return errno;
  const int file = open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const int reason = fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
  close(file);
  return reason;
}

}  // namespace

UnfinishedFile::UnfinishedFile(std::string path) : path_(std::move(path)) {
  errno = EEXIST;
  for (int i = 0; i < names_to_try && errno == EEXIST; ++i) {
    temporary_ = fmt::format("{}.part{}", path_, i);
    if (std::FILE* file = std::fopen(temporary_.c_str(), "wbx"); file != nullptr) {
      std::fclose(file);
      return;
    }
  }
  const int reason = errno;
  temporary_.clear();
  fail(reason);
}

UnfinishedFile::~UnfinishedFile() {
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void UnfinishedFile::commit() {
  if (const int reason = settle(temporary_, path_); reason != 0) fail(reason);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail(error.value());
  temporary_.clear();
}

void UnfinishedFile::fail(int reason) const {
  throw WriteError(
      fmt::format("{}: cannot be written: {}; check the folder and the space on the disk", path_,
                  reason == 0 ? "the library that writes it gives no reason" : std::strerror(reason)));
}

}  // namespace collarmesh::io
