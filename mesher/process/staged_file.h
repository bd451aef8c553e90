#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "common/replacement.h"

namespace collarmesh::process {

class Process;
class StagedFiles;

/// A file that appears under its name only when it is complete. It is made in a temporary folder beside its
/// place, and `commit` moves it to its place, together with further files that its writer makes. It takes
/// over the mode of a file that it replaces and, if permitted, the owner. The target "-" is standard output,
/// to which the file is copied. The folder is locked while it is in use. Unlocked folders older than a minute
/// were left by killed runs, so they are removed.
class StagedFile {
 public:
  /// Makes the temporary folder. Throws WriteError if the folder of `target` cannot be written to.
  StagedFile(StagedFiles& files, std::filesystem::path target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Makes the file by calling `write` with the path to write to. Errors name the target instead of that
  /// path.
  void write(const std::function<void(const std::string& path)>& write);

 private:
  friend class StagedFiles;

  std::vector<Replacement::Move> moves() const;
  void copy_to_standard_output() const;

  StagedFiles& files_;
  std::filesystem::path target_;
  std::filesystem::path folder_;
  int lock_;
};

/// The staged files of the program.
class StagedFiles {
 public:
  explicit StagedFiles(Process& process) : process_(process) {}

  /// Checks that `target`, and the files written `beside` it, can be made. Throws WriteError with the
  /// reason. Call it before long work.
  void require_writable(const std::filesystem::path& target,
                        const std::vector<std::filesystem::path>& beside = {});

  /// Flushes files to the disk and moves them to their places: either all of them, or none, which leaves the
  /// previous files as they were. Throws WriteError, also if two files have the same place. Throws Cancelled
  /// if the user has asked to stop.
  void commit(const std::vector<StagedFile*>& files);

  /// Removes files that are not committed and blocks later commits, because the program is about to end while
  /// another thread writes. Undoes a commit of this thread that is in progress; waits for one of another
  /// thread. Returns false if a commit has been completed: the command is about to succeed.
  bool abandon();

 private:
  friend class StagedFile;

  std::filesystem::path make_folder_beside(const std::filesystem::path& target);
  void take_back() noexcept;

  // A mutex that its holder may lock again: `abandon` does so if memory runs out while it is held. This also
  // works in a forked child, unlike std::recursive_mutex: the child's thread has another number.
  class Mutex {
   public:
    void lock() {
      if (held_++ == 0) mutex_.lock();
    }
    void unlock() {
      if (--held_ == 0) mutex_.unlock();
    }

   private:
    static inline thread_local int held_ = 0;
    std::mutex mutex_;
  };

  Process& process_;
  Mutex mutex_;  // guards the following variables
  std::vector<std::string> folders_;
  Replacement replacement_;  // the files replaced by the commit in progress
  bool committed_ = false;
  bool keep_folders_ = false;  // keep the folders, because their files could not be moved back
};

/// Replaces one folder by another in a message that names files.
std::string with_folder(std::string message, const std::filesystem::path& from,
                        const std::filesystem::path& to);

/// Writes a file of text. Throws WriteError.
void write_text(const std::string& path, const std::string& text);

/// Removes the temporary folder of a process that has ended. If it ended in a commit, between removing a file
/// and putting another one in its place, the removed file is restored.
void remove_dead_folder(const std::filesystem::path& folder);

}  // namespace collarmesh::process
