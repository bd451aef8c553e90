#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

/// Completion scripts for shells. They complete subcommands, options, the words that an option accepts, and
/// file names.
namespace collarmesh::cli {

/// Returns the completion script for the shell bash, zsh or fish; empty for any other.
std::string completion(const CLI::App& app, std::string_view shell);

}  // namespace collarmesh::cli
