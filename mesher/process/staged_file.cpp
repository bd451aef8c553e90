#include "process/staged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <set>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "process/process.h"

namespace collarmesh::process {

namespace fs = std::filesystem;

namespace {

constexpr const char* standard_output = "-";
constexpr const char* folder_prefix = ".collarmesh-";
constexpr std::string_view kept_prefix = "kept-";

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

std::string reason() { return std::strerror(errno); }

void require_place(const fs::path& target) {
  std::error_code ignored;
  if (fs::is_directory(target, ignored))
    throw WriteError(fmt::format("{}: is a folder; name a file in another place", target.string()));
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored))
    throw WriteError(
        fmt::format("{}: is not a regular file; name a regular file, or - with --format for standard output",
                    target.string()));
}

/// Removes the folders of runs that were killed: nobody holds their locks. Skips young folders, which may be
/// about to be locked.
void remove_dead_folders(const fs::path& parent) {
  using namespace std::chrono_literals;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& folder = entry->path();
    std::error_code ignored;
    struct stat status = {};
    if (!folder.filename().string().starts_with(folder_prefix) || lstat(folder.c_str(), &status) != 0 ||
        !S_ISDIR(status.st_mode) || status.st_uid != geteuid() ||
        fs::file_time_type::clock::now() - fs::last_write_time(folder, ignored) < 1min)
      continue;
    const int lock = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (lock < 0) continue;
    if (flock(lock, LOCK_EX | LOCK_NB) == 0) remove_dead_folder(folder);
    close(lock);
  }
}

/// Returns the folder in which a file is made before it is copied to standard output.
fs::path temporary_place() {
  std::error_code error;
  for (const fs::path& place : {fs::temp_directory_path(error), fs::path("/tmp"), fs::path("/var/tmp")})
    if (!place.empty() && access(place.c_str(), W_OK | X_OK) == 0) return place;
  return ".";
}

/// Returns a name with 64 random bits, which no other folder has. Unlike a name that mkdtemp makes, it is
/// known before the folder exists.
std::string unique_folder_name() {
  std::random_device bits;
  return fmt::format("{}{:08x}{:08x}", folder_prefix, bits(), bits());
}

}  // namespace

fs::path StagedFiles::make_folder_beside(const fs::path& target) {
  const fs::path parent = target == standard_output ? temporary_place() : folder_of(target);
  std::error_code ignored;
  if (!fs::exists(parent, ignored))
    throw WriteError(
        fmt::format("{}: its folder {} does not exist; create it first", target.string(), parent.string()));
  if (!fs::is_directory(parent, ignored))
    throw WriteError(
        fmt::format("{}: {} is not a folder; choose another place", target.string(), parent.string()));
  if (target != standard_output) require_place(target);
  remove_dead_folders(parent);
  // List the folder before creating it: the program may end at any time and must know what to remove.
  folders_.push_back((parent / unique_folder_name()).string());
  process_.supervisor.add_folder(folders_.back());
  if (mkdir(folders_.back().c_str(), S_IRWXU) != 0) {
    const std::string why = reason();
    folders_.pop_back();
    throw WriteError(
        fmt::format("{}: cannot write to the folder {} ({}); choose another or change its permissions",
                    target.string(), parent.string(), why));
  }
  return folders_.back();
}

void StagedFiles::take_back() noexcept { keep_folders_ |= !replacement_.undo(); }

// If the target is a symbolic link, the file that it points to is replaced, not the link.
StagedFile::StagedFile(StagedFiles& files, fs::path target) : files_(files), target_(std::move(target)) {
  std::error_code error;
  if (fs::is_symlink(target_, error))
    if (fs::path named = fs::weakly_canonical(target_, error); !error) target_ = std::move(named);
  const std::lock_guard lock(files_.mutex_);
  folder_ = files_.make_folder_beside(target_);
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0) flock(lock_, LOCK_EX | LOCK_NB);
}

StagedFile::~StagedFile() {
  const std::lock_guard lock(files_.mutex_);
  std::error_code ignored;
  if (!files_.keep_folders_) fs::remove_all(folder_, ignored);
  if (lock_ >= 0) close(lock_);
  std::erase(files_.folders_, folder_.native());
}

void StagedFile::write(const std::function<void(const std::string&)>& write) {
  try {
    write((folder_ / target_.filename()).string());
  } catch (const WriteError& error) {
    throw WriteError(with_folder(error.what(), folder_, target_.parent_path()));
  }
}

std::vector<Replacement::Move> StagedFile::moves() const {
  std::set<fs::path> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
  names.erase(target_.filename());
  std::vector<fs::path> ordered(names.begin(), names.end());
  ordered.push_back(target_.filename());  // the target comes last, so that its readers find the other files
  std::vector<Replacement::Move> moves;
  for (const fs::path& name : ordered) {
    const fs::path place = target_.parent_path() / name;
    std::error_code ignored;
    const bool there = fs::exists(fs::symlink_status(place, ignored));
    moves.push_back(
        {folder_ / name, place, there ? folder_ / (std::string(kept_prefix) + name.string()) : fs::path()});
  }
  return moves;
}

void StagedFile::copy_to_standard_output() const {
  std::ifstream file(folder_ / target_.filename(), std::ios::binary);
  std::vector<char> block(1 << 16);
  const auto fail = [] {
    throw WriteError(
        fmt::format("standard output: cannot be written ({}); name a file with --output", reason()));
  };
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
    if (std::fwrite(block.data(), 1, static_cast<std::size_t>(file.gcount()), stdout) !=
        static_cast<std::size_t>(file.gcount()))
      fail();
  if (std::fflush(stdout) != 0) fail();
}

void StagedFiles::commit(const std::vector<StagedFile*>& files) {
  const std::lock_guard lock(mutex_);
  process_.interrupts.stop_if_asked();
  std::vector<Replacement::Move> all;
  for (const StagedFile* file : files)
    if (file != nullptr && file->target_ != standard_output)
      for (Replacement::Move& move : file->moves()) all.push_back(std::move(move));
  std::set<fs::path> places;
  for (const Replacement::Move& move : all) {
    std::error_code error;
    if (!places.insert(fs::weakly_canonical(folder_of(move.to), error) / move.to.filename()).second)
      throw WriteError(
          fmt::format("{}: two outputs have this name; choose another for one of them", move.to.string()));
    require_place(move.to);
  }
  replacement_ = Replacement(std::move(all));
  replacement_.prepare();
  for (const StagedFile* file : files)
    if (file != nullptr && file->target_ == standard_output) file->copy_to_standard_output();
  if (const Replacement::Move* const failed = replacement_.carry_out(); failed != nullptr) {
    const std::string why = reason();
    take_back();
    throw WriteError(fmt::format(
        "{}: cannot be replaced ({}); choose another name{}", failed->to.string(), why,
        keep_folders_ ? fmt::format("; the previous files could not be restored either; they are in {}",
                                    failed->from.parent_path().string())
                      : ""));
  }
  committed_ = true;
  replacement_.settle();
}

void StagedFiles::require_writable(const fs::path& target, const std::vector<fs::path>& beside) {
  const StagedFile probe(*this, target);
  for (const fs::path& file : beside) require_place(file);
}

std::string with_folder(std::string message, const fs::path& from, const fs::path& to) {
  const std::string folder = from.string() + "/", target = to.empty() ? "" : to.string() + "/";
  for (std::size_t at = message.find(folder); at != std::string::npos;
       at = message.find(folder, at + target.size()))
    message.replace(at, folder.size(), target);
  return message;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw WriteError(fmt::format("{}: cannot be written; is the disk full?", path));
}

void remove_dead_folder(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (!name.starts_with(kept_prefix)) continue;
    const fs::path place = folder.parent_path() / name.substr(kept_prefix.size());
    if (!fs::exists(fs::symlink_status(place, ignored))) fs::rename(entry->path(), place, ignored);
  }
  fs::remove_all(folder, error);
}

bool StagedFiles::abandon() {
  const std::lock_guard lock(mutex_);
  if (!committed_) {
    mutex_.lock();  // for good, because the program is about to end
    take_back();
  }
  std::error_code ignored;
  if (!keep_folders_)
    for (const std::string& folder : folders_) fs::remove_all(folder, ignored);
  return !committed_;
}

}  // namespace collarmesh::process
