#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

/// Standard output and standard error, which may be full, closed, or pipes that nobody reads.
namespace collarmesh::process {

/// Gives every standard stream that is closed a device in its place, so that no file that is opened later
/// gets its number: messages would be written into it. Reading from and writing to the stream still fail.
void replace_closed_streams();

/// From now on this process says nothing: of several that do the same work another one does.
void be_silent();

/// Messages, to standard error. What cannot be written is lost: a run does not fail for its messages.
void tell_text(const std::string& text) noexcept;
template <class... Values>
void tell(fmt::format_string<Values...> format, Values&&... values) {
  tell_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Results, to standard output, written when it returns. Throws WriteError.
void print_result(const std::string& text);

}  // namespace collarmesh::process
