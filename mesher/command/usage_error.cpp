#include "command/usage_error.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "files/edit_distance.h"

namespace collarmesh::command {

namespace {

/// Returns the command in which the mistake was made.
const CLI::App& command_of(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

std::string similar_option(const CLI::App& command, const std::string& wanted) {
  std::size_t nearest = 1 + wanted.size() / 4;
  std::string found;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) {
      const std::size_t distance = files::edit_distance(wanted, "--" + name);
      if (distance > nearest || (distance == nearest && !found.empty())) continue;
      nearest = distance;
      found = "--" + name;
    }
  return found;
}

std::string unexpected(const CLI::App& app) {
  const CLI::App& command = command_of(app);
  std::vector<std::string> extras = command.remaining();
  if (extras.empty()) extras = app.remaining();
  if (extras.empty()) return "there is one argument too many; see --help";
  const std::string argument = extras.front().substr(0, extras.front().find('='));
  const std::string similar = similar_option(command, argument);
  return similar.empty() ? fmt::format("{}: there is no such option or argument; see --help", argument)
                         : fmt::format("{}: there is no such option; did you mean {}?", argument, similar);
}

/// Returns the message for an option that lacks its value or is repeated. In CLI11's message the option's
/// name stands before the colon.
std::string mismatch(const CLI::App& app, const std::string& said) {
  const std::string name = said.substr(0, said.find(':'));
  if (said.find("At Most") != std::string::npos)
    return fmt::format("{}: is given more than once; give it once", name);
  const CLI::Option* option = command_of(app).get_option_no_throw(name);
  const std::string type = option == nullptr ? "value" : option->get_type_name();
  return fmt::format("{}: its {} is missing; write {} {}", name, type, name, type);
}

}  // namespace

std::string usage_of(const std::string& command) {
  if (command == "check") return "collarmesh check MESH --against INPUT...";
  if (command == "info") return "collarmesh info INPUT...";
  if (command == "convert") return "collarmesh convert IN... -o OUT";
  if (command == "repair") return "collarmesh repair IN... -o OUT";
  if (command == "remesh") return "collarmesh remesh MESH -o OUT";
  return "collarmesh INPUT... -o OUT";
}

std::string mistaken_command(const std::string& word) {
  std::error_code ignored;
  if (word.find_first_of("./-") != std::string::npos || std::filesystem::exists(word, ignored)) return {};
  std::string found;
  std::size_t nearest = 3;
  for (const char* command : {"check", "info", "convert", "repair", "remesh"}) {
    const std::size_t distance = files::edit_distance(word, command);
    if (distance == 0) return {};
    if (distance >= nearest) continue;
    nearest = distance;
    found = command;
  }
  return found.empty() ? found
                       : fmt::format("{}: there is no such command or file; did you mean {}?", word, found);
}

std::string usage_message(const CLI::App& app, const CLI::Error& error) {
  std::string said = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected(app);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return mismatch(app, said);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    return fmt::format("{}; write {}", said,
                       usage_of(&command_of(app) == &app ? "" : command_of(app).get_name()));
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    // The option is a flag, because values of other options are checked before they are converted. The
    // message is "Could not convert: --quiet = 5".
    const std::size_t begin = said.find("--"), end = said.find(' ', begin);
    const std::string name = begin == std::string::npos ? said : said.substr(begin, end - begin);
    return fmt::format("{}: takes no value; write {} alone", name, name);
  }
  return said;
}

}  // namespace collarmesh::command
