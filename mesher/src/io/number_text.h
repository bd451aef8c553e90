#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

/// Reads numbers from text, whatever the locale.
namespace collarmesh::io {

/// Removes a leading plus sign, which from_chars does not accept.
inline std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+' ? word.substr(1) : word;
}

/// Returns whether a decimal number that a double cannot hold is too close to 0; false: it is too large.
inline bool underflows(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  return exponent == std::string_view::npos ? word.substr(0, 2) == "0." || word.substr(0, 3) == "-0."
                                            : word.substr(exponent + 1, 1) == "-";
}

/// Reads a number. Returns false if the word is not a number as a whole. Accepts "nan" and "inf"; a number
/// that is too large becomes infinite, one too close to 0 becomes 0.
inline bool parse(std::string_view word, double& value) {
  word = without_plus(word);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::result_out_of_range && stop == end) {
    value = underflows(word) ? 0 : HUGE_VAL;
    return true;
  }
  return error == std::errc() && stop == end;
}

/// Reads an integer. Returns false if the word is not, as a whole, an integer that fits.
template <class Integer>
bool parse(std::string_view word, Integer& value) {
  word = without_plus(word);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && stop == end;
}

}  // namespace collarmesh::io
