#pragma once

#include <string>
#include <string_view>

#include "collarmesh/geometry.h"

namespace collarmesh::io {

/// A reader of words and numbers from a text in memory. It knows the current line. Line ends are \n or \r\n.
/// Every failure is a ReadError "PATH: line N: what was expected and what was found".
class TextScanner {
 public:
  /// `comment` is a character that starts a comment up to the end of the line; 0: no comments. `first_line`
  /// is the number of the line at which `text` begins. Precondition: `path` and `text` outlive the scanner.
  TextScanner(const std::string& path, std::string_view text, char comment = '#', std::size_t first_line = 1)
      : path_(path),
        begin_(text.data()),
        at_(begin_),
        end_(begin_ + text.size()),
        comment_(comment),
        line_(first_line) {}

  /// Returns whether only blanks and comments are left on this line.
  bool at_line_end() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n';
  }
  /// Returns whether only blanks, comments and line ends are left in the text.
  bool at_end() {
    while (at_line_end()) {
      if (at_ == end_) return true;
      skip_line();
    }
    return false;
  }
  /// Goes to the beginning of the next line.
  void skip_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
    if (at_ == end_) return;
    ++at_;
    ++line_;
  }

  /// Takes the next word, on this line or a later one. `what` names it in the error.
  std::string_view word(std::string_view what);
  /// Returns the next word without taking it; empty at the end.
  std::string_view peek();
  /// Takes the rest of this line, up to a comment, without surrounding blanks; goes to the next line.
  std::string_view rest_of_line();

  /// Takes this many bytes, whatever they are, and counts no lines in them; takes nothing if there are fewer.
  std::string_view raw(std::size_t count) {
    if (count > left()) return {};
    at_ += count;
    return {at_ - count, count};
  }

  double number(std::string_view what);
  /// Reads a finite number.
  double coordinate(std::string_view what);
  Point point(std::string_view what) {
    const double x = coordinate(what), y = coordinate(what), z = coordinate(what);
    return {x, y, z};
  }
  std::int64_t integer(std::string_view what);
  /// Reads a count of items that take at least `least_bytes` bytes each; a count that the rest of the text
  /// cannot hold, or `Index` cannot number, is an error.
  Index count(std::string_view what, std::size_t least_bytes);
  /// Reads an index in [first, first + size); returns it minus `first`.
  Index index(std::string_view what, std::int64_t first, std::size_t size);

  [[noreturn]] void fail(const std::string& message) const;
  /// Throws ReadError with the expected word and the one found instead.
  [[noreturn]] void fail(std::string_view expected, std::string_view found) const;

  std::size_t line() const { return line_; }
  /// Return the number of bytes that were read, and of those that are left.
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
  // Returns whether a word continues. The first comparison decides for most characters: blanks and line ends
  // are no greater than a space.
  bool in_word(char c) const {
    if (static_cast<unsigned char>(c) > ' ') return c != comment_;
    return c != '\n' && !is_blank(c) && (c != comment_ || comment_ == 0);
  }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    if (at_ != end_ && *at_ == comment_ && comment_ != 0)
      while (at_ != end_ && *at_ != '\n') ++at_;
  }

  const std::string& path_;
  const char* begin_;
  const char* at_;
  const char* end_;
  char comment_;
  std::size_t line_;
};

/// Returns a piece of a file in quotes for a message: cut off if long, with printable characters only.
std::string in_quotes(std::string_view text);

}  // namespace collarmesh::io
