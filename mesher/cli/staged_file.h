#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>

namespace collarmesh::cli {

/// A file that appears under its name when it is complete, or not at all: it is made in a temporary
/// folder beside its place and moved there by `commit`, with those that its writer makes beside it.
/// The target "-" is standard output, to which the file is copied.
class StagedFile {
 public:
  /// Throws WriteError when the folder of `target` cannot be written to.
  explicit StagedFile(std::filesystem::path target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Make the file: `write` gets the path to write to. Errors name the target instead of it.
  void write(const std::function<void(const std::string& path)>& write);

  /// Move files to their places. Throws WriteError, or Cancelled when the user asked to stop before.
  static void commit(std::initializer_list<StagedFile*> files);

 private:
  void move_to_place() const;
  void copy_to_standard_output() const;

  std::filesystem::path target_;
  std::filesystem::path folder_;
};

/// Can a file be made there? Throws WriteError saying why not: meant to be asked before long work.
void require_writable(const std::filesystem::path& target);

/// Remove what is not committed and block later commits: the program is about to end while another
/// thread writes. False when the commit has taken place, the command is then about to succeed.
bool abandon_staged_files();

}  // namespace collarmesh::cli
