#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

/// What the values of options look like. A value that does not fit is answered with what would.
namespace collarmesh::cli {

/// A number that is the whole text.
template <class Number>
bool parse_whole(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "7=0.25" is {7, 0.25}. Throws std::invalid_argument saying what is expected.
std::pair<Tag, double> parse_tag_value(std::string_view text);

/// "1.5G" in bytes; K, M, G and T are powers of 1024, in either case. Throws std::invalid_argument.
std::size_t parse_memory(std::string_view text);

/// A finite number in an interval, so that "nan" and "inf" are refused as well.
CLI::Validator number_in(double low, double high, const std::string& name);

/// A whole number that is not negative: CLI11 takes "-5" for one.
CLI::Validator whole_number();

/// One of these words.
CLI::Validator one_of(const std::vector<std::string>& words);

/// "STL" becomes ".stl"; one of these extensions.
CLI::Validator format_name(const std::vector<std::string>& extensions);

/// ".off .stl"
std::string list(const std::vector<std::string>& extensions);

}  // namespace collarmesh::cli
