#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace collarmesh::process {

/// A file that appears under its name when it is complete, or not at all: it is made in a temporary folder in
/// the same place, and `commit` moves it there, together with further files that its writer makes beside it.
/// A replaced file passes on its mode and, where permitted, its owner. The target "-" is standard output, to
/// which the file is copied.
///
/// The folder is locked as long as it is in use: unlocked folders were left by runs that were killed, and are
/// removed.
class StagedFile {
 public:
  /// Makes the temporary folder. Throws WriteError if the folder of `target` cannot be written to.
  explicit StagedFile(std::filesystem::path target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Makes the file: `write` gets the path to write to. Errors name the target instead of it.
  void write(const std::function<void(const std::string& path)>& write);

  /// Flushes files to the disk and moves them to their places: all of them, or none, leaving the previous
  /// files as they were. Throws WriteError, also if two would have the same place, or Cancelled if the user
  /// asked to stop before.
  static void commit(const std::vector<StagedFile*>& files);

 private:
  struct Move {
    std::filesystem::path from, to, kept;  // kept: the previous file
  };
  std::vector<Move> moves() const;
  void copy_to_standard_output() const;

  std::filesystem::path target_;
  std::filesystem::path folder_;
  int lock_;
};

/// Checks that `target`, and the files written `beside` it, can be made there. Throws WriteError with the
/// reason. Call it before long work.
void require_writable(const std::filesystem::path& target,
                      const std::vector<std::filesystem::path>& beside = {});

/// Removes the temporary folder of a process that has ended. If it ended in a commit, between removing a file
/// and putting another one in its place, the removed file is restored.
void remove_dead_folder(const std::filesystem::path& folder);

/// Removes files that are not committed and blocks later commits, because the program is about to end while
/// another thread writes. A commit in progress is undone if this thread was making it, otherwise waited for.
/// Returns false if the commit has taken place; the command is then about to succeed.
bool abandon_staged_files();

}  // namespace collarmesh::process
