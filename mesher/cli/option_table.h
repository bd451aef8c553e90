#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// What the table of options says in forms of other programs.
namespace collarmesh::cli {

/// A manual page of section 1, in roff. `footer`: exit codes and units.
std::string man_page(const CLI::App& app, const std::string& version, const std::string& footer);

/// For bash: subcommands, options, words that options take, files.
std::string bash_completion(const CLI::App& app);

}  // namespace collarmesh::cli
