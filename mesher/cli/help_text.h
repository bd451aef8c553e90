#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace collarmesh::cli {

/// Returns the subcommands of the program or of a command.
std::vector<const CLI::App*> subcommands(const CLI::App& app);

/// The help of CLI11 with our own usage lines, wrapped for a terminal of 80 columns.
class HelpText : public CLI::Formatter {
 public:
  HelpText();
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

}  // namespace collarmesh::cli
