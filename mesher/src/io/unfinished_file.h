#pragma once

#include <string>

namespace collarmesh::io {

/// A file that appears under its name when it is complete, or not at all: until `commit` renames it, it
/// is a temporary file beside its place. Throws WriteError with the path and the system's reason.
class UnfinishedFile {
 public:
  /// Creates the temporary file, empty.
  explicit UnfinishedFile(std::string path);
  /// Removes the temporary file unless it was committed.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Where to write.
  const std::string& temporary() const { return temporary_; }
  /// It is on the disk before it takes its name, and has the mode of the file that it replaces.
  /// Precondition: the temporary file is closed.
  void commit();
  /// `reason` is the system's number of an error, 0: unknown.
  [[noreturn]] void fail(int reason) const;

 private:
  std::string path_, temporary_;
};

}  // namespace collarmesh::io
