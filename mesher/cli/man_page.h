#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace collarmesh::cli {

/// Returns a manual page of section 1, in roff. `footer` is text about exit codes and units.
std::string man_page(const CLI::App& app, const std::string& version, const std::string& footer);

}  // namespace collarmesh::cli
