#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace collarmesh {

/// The replacement of files by complete ones from temporary places on the same disk: either all are replaced,
/// or none. The caller removes the temporary files, also those that remain after a failure.
class Replacement {
 public:
  struct Move {
    std::filesystem::path from, to;
    std::filesystem::path kept;  ///< where the file that is replaced stays meanwhile; empty: no file is
                                 ///< replaced, or this is the only move, so it need not be kept
  };

  Replacement() = default;
  explicit Replacement(std::vector<Move> moves) : moves_(std::move(moves)) {}

  /// Gives each new file the mode and, where permitted, the owner of the file that it replaces, and flushes
  /// it to the disk. Throws WriteError.
  void prepare() const;
  /// Moves the files to their places. Returns null or, if a move fails, that move, with the reason in
  /// `errno`; the caller must then undo the moves before it. Allocates nothing.
  const Move* carry_out();
  /// Undoes the completed moves, also those of a `carry_out` that has not returned. Returns whether all
  /// previous files are back in their places. Allocates nothing.
  bool undo() noexcept;
  /// Makes completed moves final, so that `undo` no longer undoes them. Flushes their folders, too.
  void settle();

 private:
  std::vector<Move> moves_;
  std::size_t done_ = 0;  // number of moves that are completed
};

}  // namespace collarmesh
