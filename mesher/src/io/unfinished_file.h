#pragma once

#include <string>

namespace collarmesh::io {

/// A file that appears under its name when it is complete, or not at all: until `commit` renames it, it is a
/// temporary file in the same folder. Throws WriteError with the path and the system's reason.
class UnfinishedFile {
 public:
  /// Creates the temporary file, empty.
  explicit UnfinishedFile(std::string path);
  /// Removes the temporary file unless it was committed.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Returns the path to write to.
  const std::string& temporary() const { return temporary_; }
  /// Flushes the file to the disk, gives it the mode and owner of the file that it replaces, and renames it.
  /// Precondition: the temporary file is closed.
  void commit();
  /// Throws WriteError. `reason` is the system's error number, 0: unknown.
  [[noreturn]] void fail(int reason) const;

 private:
  std::string path_, temporary_;
};

}  // namespace collarmesh::io
