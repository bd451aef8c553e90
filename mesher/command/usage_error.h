#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace collarmesh::command {

/// Returns a message for a mistake on the command line, with a correction: a single line, without a line end.
/// CLI11's own messages mention its types and patterns.
std::string usage_message(const CLI::App& app, const CLI::Error& error);

/// Returns a message for a first argument that is no file but is spelled nearly like a command; otherwise
/// empty.
std::string mistaken_command(const std::string& word);

/// Returns the usage line of a command; the one that meshes has an empty name.
std::string usage_of(const std::string& command);

}  // namespace collarmesh::command
