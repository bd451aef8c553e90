#include "help_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "command/usage_error.h"

namespace collarmesh::cli {

namespace {

constexpr std::size_t columns = 78, first_column = 34;  // `columns`: 80, less 2 for the indent of --help-all

/// Wraps text to lines of at most this many characters; longer words stay whole.
std::string wrapped(std::string_view text, std::size_t width = columns - first_column) {
  std::string result;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (used > 0 && used + 1 + word.size() > width) {
      result += '\n';
      used = 0;
    } else if (used > 0) {
      result += ' ';
      ++used;
    }
    result += word;
    used += word.size();
  }
  return result;
}

}  // namespace

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

HelpText::HelpText() { column_width(first_column); }

std::string HelpText::make_usage(const CLI::App* app, std::string name) const {
  if (app->get_parent() != nullptr) return CLI::Formatter::make_usage(app, name);
  std::string text = "Usage:";
  for (const char* command : {"", "remesh", "check", "info", "convert", "repair"})
    text += fmt::format("{} {} [options]\n", text.size() > 6 ? "      " : "", usage_of(command));
  return text;
}

std::string HelpText::make_description(const CLI::App* app) const {
  return app->get_description().empty() ? std::string() : wrapped(app->get_description(), columns) + "\n";
}

std::string HelpText::make_option_desc(const CLI::Option* option) const {
  return wrapped(option->get_description());
}

/// Leaves out the list of other options that an option needs: a message names them if they are missing.
std::string HelpText::make_option_opts(const CLI::Option* option) const {
  const std::string all = CLI::Formatter::make_option_opts(option);
  return all.substr(0, all.find(" Needs:"));
}

std::string HelpText::make_subcommand(const CLI::App* command) const {
  std::ostringstream out;
  CLI::detail::format_help(out, command->get_name(), wrapped(command->get_description()), first_column);
  return out.str();
}

}  // namespace collarmesh::cli
