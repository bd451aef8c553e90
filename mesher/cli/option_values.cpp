#include "option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace collarmesh::cli {

namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return text;
}

}  // namespace

std::pair<Tag, double> parse_tag_value(std::string_view text) {
  const std::size_t equals = text.find('=');
  std::pair<Tag, double> result;
  if (equals == std::string_view::npos || !parse_whole(text.substr(0, equals), result.first) ||
      !parse_whole(text.substr(equals + 1), result.second) || !std::isfinite(result.second) ||
      result.second <= 0)
    throw std::invalid_argument(
        fmt::format("'{}' is not TAG=LENGTH with a whole number and a positive length, as in 7=0.25", text));
  return result;
}

std::size_t parse_memory(std::string_view text) {
  constexpr std::string_view prefixes = "kmgt";
  const std::string whole = lower(std::string(text));
  std::string_view number = whole;
  if (number.ends_with("ib"))
    number.remove_suffix(2);
  else if (number.ends_with("b"))
    number.remove_suffix(1);
  double unit = 1;
  if (!number.empty())
    if (const std::size_t prefix = prefixes.find(number.back()); prefix != std::string_view::npos) {
      unit = std::pow(1024.0, static_cast<double>(prefix + 1));
      number.remove_suffix(1);
    }
  double value = 0;
  if (!parse_whole(number, value) || !(value >= 0) || value * unit >= 0x1p63)
    throw std::invalid_argument(fmt::format("'{}' is not a size such as 500M, 1.5G or 2000000000", text));
  return static_cast<std::size_t>(value * unit);
}

CLI::Validator number_in(double low, double high, const std::string& name) {
  return CLI::Validator(
      [=](std::string& text) {
        double number = 0;
        if (parse_whole(text, number) && number >= low && number <= high) return std::string();
        return fmt::format("'{}' is not {}", text, name);
      },
      "");
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& text) {
        std::uint64_t number = 0;
        return parse_whole(text, number) ? std::string()
                                         : fmt::format("'{}' is not a whole number >= 0", text);
      },
      "");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](std::string& text) {
        return std::find(words.begin(), words.end(), text) != words.end()
                   ? std::string()
                   : fmt::format("'{}' is not one of {}", text, fmt::join(words, ", "));
      },
      "");
}

CLI::Validator format_name(const std::vector<std::string>& extensions) {
  return CLI::Validator(
      [extensions](std::string& text) {
        text = lower(text);
        if (!text.starts_with('.')) text = '.' + text;
        return std::find(extensions.begin(), extensions.end(), text) != extensions.end()
                   ? std::string()
                   : fmt::format("'{}' is not known; use {}", text, list(extensions));
      },
      "");
}

std::string list(const std::vector<std::string>& extensions) {
  return fmt::format("{}", fmt::join(extensions, " "));
}

}  // namespace collarmesh::cli
