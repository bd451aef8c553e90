#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace collarmesh::cli {

/// What a mistake on the command line is and what to write instead; one line without its end.
/// CLI11's own messages tell of its types and its patterns.
std::string usage_message(const CLI::App& app, const CLI::Error& error);

/// What is wrong with a first argument that is no file and nearly a command; else empty.
std::string mistaken_command(const std::string& word);

/// How a command is called; the one that meshes has an empty name.
std::string usage_of(const std::string& command);

}  // namespace collarmesh::cli
