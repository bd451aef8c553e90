#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

/// The syntax of options' values. The error for a wrong value describes valid ones.
namespace collarmesh::command {

/// Throws the error for a wrong value of an option. The message says why the value is wrong.
template <class... Values>
[[noreturn]] void reject(const std::string& option, fmt::format_string<Values...> message,
                         Values&&... values) {
  throw CLI::ValidationError(option, fmt::format(message, std::forward<Values>(values)...));
}

/// Returns a check for numbers from `low` to `high`; it rejects "nan" and "inf", too. `name` describes valid
/// numbers in the error.
CLI::Validator number_in(double low, double high, const std::string& name);

/// Returns a check that a value is one of these extensions. It first turns "STL" into ".stl".
CLI::Validator format_name(const std::vector<std::string>& extensions);

/// Joins extensions: ".off .stl"
std::string list(const std::vector<std::string>& extensions);

}  // namespace collarmesh::command
