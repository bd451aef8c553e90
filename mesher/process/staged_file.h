#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace collarmesh::process {

/// A file that appears under its name when it is complete, or not at all: it is made in a temporary
/// folder beside its place and moved there by `commit`, with those that its writer makes beside it.
/// A file that it replaces passes on its mode and, where permitted, its owner.
/// The target "-" is standard output, to which the file is copied.
///
/// The folder is locked as long as it is in use: those without a lock are of runs that were killed, and are
/// removed.
class StagedFile {
 public:
  /// Throws WriteError when the folder of `target` cannot be written to.
  explicit StagedFile(std::filesystem::path target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Makes the file: `write` gets the path to write to. Errors name the target instead of it.
  void write(const std::function<void(const std::string& path)>& write);

  /// Flush files to the disk and move them to their places: all of them, or none, with what was there before
  /// left as it was. Throws WriteError, also where two would have one place, or Cancelled when the user asked
  /// to stop before.
  static void commit(const std::vector<StagedFile*>& files);

 private:
  struct Move {
    std::filesystem::path from, to, kept;  // kept: the file that was there before
  };
  std::vector<Move> moves() const;
  void copy_to_standard_output() const;

  std::filesystem::path target_;
  std::filesystem::path folder_;
  int lock_;
};

/// Can `target`, and what is written `beside` it, be made there? Throws WriteError saying why not: meant to
/// be asked before long work.
void require_writable(const std::filesystem::path& target,
                      const std::vector<std::filesystem::path>& beside = {});

/// Removes the temporary folder of a process that has ended. Where it ended in a commit, between taking a
/// file away and putting another one in its place, the former is put back.
void remove_dead_folder(const std::filesystem::path& folder);

/// Removes what is not committed and block later commits: the program is about to end while another thread
/// writes. A commit that has begun is taken back when this thread was at it, else waited for. False when the
/// commit has taken place, the command is then about to succeed.
bool abandon_staged_files();

}  // namespace collarmesh::process
