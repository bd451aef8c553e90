#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

/// The syntax of options' values. The error for a wrong value describes valid ones.
namespace collarmesh::command {

/// Throws the error for a wrong value.
template <class... Values>
[[noreturn]] void reject(const std::string& option, fmt::format_string<Values...> message,
                         Values&&... values) {
  throw CLI::ValidationError(option, fmt::format(message, std::forward<Values>(values)...));
}

/// Accepts a finite number in an interval, so that "nan" and "inf" are rejected as well.
CLI::Validator number_in(double low, double high, const std::string& name);

/// Accepts one of these extensions; "STL" becomes ".stl".
CLI::Validator format_name(const std::vector<std::string>& extensions);

/// Joins extensions: ".off .stl"
std::string list(const std::vector<std::string>& extensions);

}  // namespace collarmesh::command
