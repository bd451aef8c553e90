#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// What the values of options look like. A value that does not fit is answered with what would.
namespace collarmesh::cli {

/// A finite number in an interval, so that "nan" and "inf" are refused as well.
CLI::Validator number_in(double low, double high, const std::string& name);

/// A whole number that is not negative: CLI11 takes "-5" for one.
CLI::Validator whole_number();

/// "STL" becomes ".stl"; one of these extensions.
CLI::Validator format_name(const std::vector<std::string>& extensions);

/// ".off .stl"
std::string list(const std::vector<std::string>& extensions);

}  // namespace collarmesh::cli
