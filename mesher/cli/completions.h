#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

/// Completions for shells, made from the table of options: subcommands, options, words that options take,
/// files.
namespace collarmesh::cli {

/// Returns the completion script for the shell bash, zsh or fish; empty for any other.
std::string completion(const CLI::App& app, std::string_view shell);

}  // namespace collarmesh::cli
