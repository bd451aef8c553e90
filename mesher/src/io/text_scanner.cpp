#include "io/text_scanner.h"

#include <fmt/format.h>

#include <cmath>

#include "collarmesh/error.h"
#include "io/number_text.h"

namespace collarmesh::io {

std::string_view TextScanner::word(std::string_view what) {
  const std::string_view next = peek();
  if (next.empty()) fail(fmt::format("expected {}, found the end of the file", what));
  at_ += next.size();
  return next;
}

std::string_view TextScanner::peek() {
  if (at_end()) return {};
  const char* stop = at_;
  while (stop != end_ && in_word(*stop)) ++stop;
  return {at_, static_cast<std::size_t>(stop - at_)};
}

std::string_view TextScanner::rest_of_line() {
  const char* first = at_;
  while (at_ != end_ && *at_ != '\n' && (*at_ != comment_ || comment_ == 0)) ++at_;
  const char* last = at_;
  while (first != last && is_blank(*first)) ++first;
  while (first != last && is_blank(last[-1])) --last;
  skip_line();
  return {first, static_cast<std::size_t>(last - first)};
}

double TextScanner::number(std::string_view what) {
  const std::string_view text = word(what);
  double value = 0;
  if (!parse(text, value)) fail(what, text);
  return value;
}

double TextScanner::coordinate(std::string_view what) {
  const std::string_view text = word(what);
  double value = 0;
  if (!parse(text, value)) fail(what, text);
  if (!std::isfinite(value)) fail(fmt::format("{}, a finite number", what), text);
  return value;
}

std::int64_t TextScanner::integer(std::string_view what) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse(text, value)) fail(fmt::format("{}, an integer", what), text);
  return value;
}

Index TextScanner::count(std::string_view what, std::size_t least_bytes) {
  const std::string_view text = word(what);
  std::uint64_t value = 0;
  if (!parse(text, value)) fail(fmt::format("{}, an integer of at least 0", what), text);
  // One more byte, because the last line may lack its line end.
  if (value > (left() + 1) / least_bytes || value >= none)
    fail(fmt::format("{} is {}, but only {} bytes follow; the file is cut off or its header is wrong", what,
                     value, left()));
  return static_cast<Index>(value);
}

Index TextScanner::index(std::string_view what, std::int64_t first, std::size_t size) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse(text, value)) fail(fmt::format("{}, an integer", what), text);
  if (value < first || value - first >= static_cast<std::int64_t>(size))
    fail(size == 0 ? fmt::format("{} is {}, but there is nothing to refer to", what, value)
                   : fmt::format("{} is {}, but has to be from {} to {}", what, value, first,
                                 first + static_cast<std::int64_t>(size) - 1));
  return static_cast<Index>(value - first);
}

void TextScanner::fail(const std::string& message) const {
  throw ReadError(fmt::format("{}: line {}: {}", path_, line_, message));
}

void TextScanner::fail(std::string_view expected, std::string_view found) const {
  fail(fmt::format("expected {}, found {}", expected, in_quotes(found)));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace collarmesh::io
