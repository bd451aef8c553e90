#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace collarmesh::process {

/// Standard output and standard error, which may be full, closed, or pipes that nobody reads.
class Console {
 public:
  /// Opens /dev/null in place of every standard stream that is closed. Otherwise a file opened later would
  /// get the stream's number, and the program's messages would go to that file. Using the stream still fails.
  Console();

  /// Silences this process. When several ranks do the same work, only one prints.
  void be_silent() { silent_ = true; }

  /// Prints a message to standard error. Ignores errors: a run goes on if its messages cannot be printed.
  void tell_text(const std::string& text) const noexcept;
  template <class... Values>
  void tell(fmt::format_string<Values...> format, Values&&... values) const {
    tell_text(fmt::format(format, std::forward<Values>(values)...));
  }

  /// Prints results to standard output, flushed on return. Throws WriteError.
  void print_result(const std::string& text) const;

 private:
  bool silent_ = false;
};

}  // namespace collarmesh::process
