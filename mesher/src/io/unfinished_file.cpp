#include "io/unfinished_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "collarmesh/error.h"
#include "common/replacement.h"

namespace collarmesh::io {

namespace {

constexpr int names_to_try = 100;

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
  Replacement replacement({{temporary_, path_, {}}});
  replacement.prepare();
  if (replacement.carry_out() != nullptr) fail(errno);
  temporary_.clear();
}

void UnfinishedFile::fail(int reason) const {
  throw WriteError(
      fmt::format("{}: cannot be written: {}; check the folder and the space on the disk", path_,
                  reason == 0 ? "the library that writes it gives no reason" : std::strerror(reason)));
}

}  // namespace collarmesh::io
