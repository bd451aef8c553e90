#include "common/replacement.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>

#include "collarmesh/error.h"

namespace collarmesh {

namespace fs = std::filesystem;

namespace {

/// Flushes a file or a folder. Returns whether this succeeded or the file system cannot flush (EINVAL,
/// ENOTSUP).
bool flushed(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const int reason = fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
  close(file);
  errno = reason;
  return reason == 0;
}

bool keep_mode_and_owner(const fs::path& before, const fs::path& staged) {
  struct stat status = {};
  if (stat(before.c_str(), &status) != 0) return true;
  if (chown(staged.c_str(), status.st_uid, status.st_gid) != 0 &&
      chown(staged.c_str(), -1, status.st_gid) != 0) {
    // Only root may give files to another owner.
  }
  return chmod(staged.c_str(), status.st_mode & 07777) == 0;
}

/// Gives a file the second name `kept` (a hard link) or, if links are not supported, moves it there.
bool keep(const fs::path& place, const fs::path& kept) {
  return link(place.c_str(), kept.c_str()) == 0 || rename(place.c_str(), kept.c_str()) == 0;
}

}  // namespace

void Replacement::prepare() const {
  for (const Move& move : moves_) {
    if (!keep_mode_and_owner(move.to, move.from))
      throw WriteError(
          fmt::format("{}: cannot keep its permissions ({})", move.to.string(), std::strerror(errno)));
    if (!flushed(move.from))
      throw WriteError(
          fmt::format("{}: cannot be written to the disk ({})", move.to.string(), std::strerror(errno)));
  }
}

const Replacement::Move* Replacement::carry_out() {
  for (const Move& move : moves_) {
    const bool kept = move.kept.empty() || keep(move.to, move.kept);
    if (kept) ++done_;
    if (kept && rename(move.from.c_str(), move.to.c_str()) == 0) continue;
    if (kept && move.kept.empty()) --done_;  // the file there is not ours, so undo() must not remove it
    return &move;
  }
  return nullptr;
}

bool Replacement::undo() noexcept {
  bool restored = true;
  for (; done_ > 0; --done_) {
    const Move& last = moves_[done_ - 1];
    restored &=
        (last.kept.empty() ? unlink(last.to.c_str()) : rename(last.kept.c_str(), last.to.c_str())) == 0;
  }
  return restored;
}

void Replacement::settle() {
  done_ = 0;
  std::set<fs::path> folders;
  for (const Move& move : moves_) folders.insert(move.to.has_parent_path() ? move.to.parent_path() : ".");
  for (const fs::path& folder : folders) flushed(folder);  // the files are in place, so errors do not matter
}

}  // namespace collarmesh
