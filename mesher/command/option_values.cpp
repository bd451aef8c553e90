#include "command/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "collarmesh/io/tet_mesh_io.h"
#include "common/lower_case.h"

namespace collarmesh::command {

namespace {

/// Reads a number; the text must contain nothing else.
template <class Number>
bool read_whole(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

CLI::Validator number_in(double low, double high, const std::string& name) {
  return CLI::Validator(
      [=](std::string& text) {
        double number = 0;
        if (read_whole(text, number) && number >= low && number <= high) return std::string();
        return fmt::format("'{}' is not {}", text, name);
      },
      "");
}

CLI::Validator format_name(const std::vector<std::string>& extensions) {
  return CLI::Validator(
      [extensions](std::string& text) {
        text = lower_case(text);
        if (!text.starts_with('.')) text = '.' + text;
        const std::string missing = io::missing_library({}, text);
        if (!missing.empty()) return missing;
        return std::find(extensions.begin(), extensions.end(), text) != extensions.end()
                   ? std::string()
                   : fmt::format("'{}' is not known; use {}", text, list(extensions));
      },
      "");
}

std::string list(const std::vector<std::string>& extensions) {
  return fmt::format("{}", fmt::join(extensions, " "));
}

}  // namespace collarmesh::command
