#include "staged_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <vector>

#include "collarmesh/error.h"
#include "interrupt.h"

namespace collarmesh::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* standard_output = "-";

std::mutex staged_mutex;
std::vector<fs::path> staged_folders;
bool committed = false;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

fs::path make_folder_beside(const fs::path& target) {
  const fs::path parent = target == standard_output ? fs::temp_directory_path() : folder_of(target);
  std::error_code ignored;
  if (!fs::exists(parent, ignored))
    throw WriteError(
        fmt::format("{}: its folder {} does not exist; create it first", target.string(), parent.string()));
  if (!fs::is_directory(parent, ignored))
    throw WriteError(
        fmt::format("{}: {} is not a folder; choose another place", target.string(), parent.string()));
  if (fs::is_directory(target, ignored))
    throw WriteError(fmt::format("{}: is a folder; name a file in it", target.string()));
  if (target != standard_output && fs::exists(target, ignored) && !fs::is_regular_file(target, ignored))
    throw WriteError(fmt::format("{}: is no regular file; name one, or - with --format", target.string()));
  std::string name = (parent / ".collarmesh-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw WriteError(
        fmt::format("{}: cannot write to the folder {} ({}); choose another or change its permissions",
                    target.string(), parent.string(), std::strerror(errno)));
  return name;
}

}  // namespace

// What a symbolic link names is replaced, not the link.
StagedFile::StagedFile(fs::path target) : target_(std::move(target)) {
  std::error_code error;
  if (fs::is_symlink(target_, error))
    if (fs::path named = fs::weakly_canonical(target_, error); !error) target_ = std::move(named);
  const std::lock_guard lock(staged_mutex);
  folder_ = make_folder_beside(target_);
  staged_folders.push_back(folder_);
}

StagedFile::~StagedFile() {
  const std::lock_guard lock(staged_mutex);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  std::erase(staged_folders, folder_);
}

void StagedFile::write(const std::function<void(const std::string&)>& write) {
  const std::string staged = (folder_ / target_.filename()).string();
  try {
    write(staged);
  } catch (const WriteError& error) {
    throw WriteError(replaced(error.what(), staged, target_.string()));
  }
}

void StagedFile::move_to_place() const {
  if (target_ == standard_output) {
    copy_to_standard_output();
    return;
  }
  std::error_code error;
  // The target last: who sees it sees the others too.
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.path().filename() != target_.filename()) names.push_back(entry.path().filename());
  names.push_back(target_.filename());
  for (const fs::path& name : names) {
    const fs::path place = target_.parent_path() / name;
    fs::rename(folder_ / name, place, error);
    if (error)
      throw WriteError(
          fmt::format("{}: cannot be replaced ({}); choose another name", place.string(), error.message()));
  }
}

void StagedFile::copy_to_standard_output() const {
  std::ifstream file(folder_ / target_.filename(), std::ios::binary);
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
    if (std::fwrite(block.data(), 1, static_cast<std::size_t>(file.gcount()), stdout) !=
        static_cast<std::size_t>(file.gcount()))
      throw WriteError(fmt::format("standard output: cannot be written ({}); name a file with --output",
                                   std::strerror(errno)));
  if (std::fflush(stdout) != 0)
    throw WriteError(fmt::format("standard output: cannot be written ({}); name a file with --output",
                                 std::strerror(errno)));
}

void StagedFile::commit(std::initializer_list<StagedFile*> files) {
  const std::lock_guard lock(staged_mutex);
  stop_if_interrupted();
  for (const StagedFile* file : files)
    if (file != nullptr) file->move_to_place();
  committed = true;
}

void require_writable(const fs::path& target) { const StagedFile probe(target); }

bool abandon_staged_files() {
  std::unique_lock lock(staged_mutex);
  if (committed) return false;
  lock.release();  // held until the program ends
  std::error_code ignored;
  for (const fs::path& folder : staged_folders) fs::remove_all(folder, ignored);
  return true;
}

}  // namespace collarmesh::cli
