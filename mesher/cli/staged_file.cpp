#include "staged_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

#include "collarmesh/error.h"
#include "interrupt.h"

namespace collarmesh::cli {

namespace fs = std::filesystem;

namespace {

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
  const fs::path parent = folder_of(target);
  std::error_code ignored;
  if (!fs::exists(parent, ignored))
    throw WriteError(
        fmt::format("{}: its folder {} does not exist; create it first", target.string(), parent.string()));
  if (!fs::is_directory(parent, ignored))
    throw WriteError(
        fmt::format("{}: {} is not a folder; choose another place", target.string(), parent.string()));
  if (fs::is_directory(target, ignored))
    throw WriteError(fmt::format("{}: is a folder; name a file in it", target.string()));
  std::string name = (parent / ".collarmesh-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw WriteError(
        fmt::format("{}: cannot write to the folder {} ({}); choose another or change its permissions",
                    target.string(), parent.string(), std::strerror(errno)));
  return name;
}

}  // namespace

StagedFile::StagedFile(fs::path target) : target_(std::move(target)) {
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
  std::error_code error;
  fs::rename(folder_ / target_.filename(), target_, error);
  if (error)
    throw WriteError(
        fmt::format("{}: cannot be replaced ({}); choose another name", target_.string(), error.message()));
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
