#include "completions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "arguments.h"
#include "help_text.h"

namespace collarmesh::cli {

namespace {

std::string names_of_subcommands(const CLI::App& app) {
  std::string names;
  for (const CLI::App* sub : subcommands(app)) names += (names.empty() ? "" : " ") + sub->get_name();
  return names;
}

/// Returns the numbers that an option accepts, as in "0 1 2 3", if they are few; empty for other options.
std::string numbers_of(const std::string& name) {
  constexpr double few = 8;
  for (const Option& option : option_table())
    if (option.name == name && option.kind() == Option::Kind::count && option.high - option.low < few) {
      std::string numbers;
      for (double number = option.low; number <= option.high; ++number)
        numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", number);
      return numbers;
    }
  return {};
}

/// Returns the values to choose from, with blanks between them: words such as those of "on|off", the formats,
/// or a few numbers; empty if the option takes other values.
std::string words_of(const CLI::Option& option) {
  std::string words = option.get_type_name();
  if (words == "FORMAT") {
    words.clear();
    for (const std::string& format : all_formats()) words += (words.empty() ? "" : " ") + format.substr(1);
    return words;
  }
  if (words.find('|') == std::string::npos)
    return option.get_lnames().empty() ? std::string() : numbers_of(option.get_lnames().front());
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

bool takes_value(const CLI::Option& option) { return option.get_expected_max() != 0; }

bool takes_file(const CLI::Option& option) {
  return option.get_type_name().starts_with("FILE") ||
         (option.get_type_name().empty() && takes_value(option));
}

/// Returns the first clause of a description, up to its first semicolon.
std::string short_text(const std::string& description) {
  return description.substr(0, description.find(';'));
}

/// Quotes text with single quotes, for any of the shells. Only fish takes backslashes inside single quotes as
/// escapes.
std::string quoted_text(std::string_view text, bool backslashes_escape) {
  std::string result = "'";
  for (const char c : text)
    if (c == '\'')
      result += "'\\''";
    else if (c == '\\' && backslashes_escape)
      result += "\\\\";
    else
      result += c;
  return result + "'";
}

std::string long_names(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      names += fmt::format("{}--{}", names.empty() ? "" : " ", name);
  return names;
}

std::string bash_completion(const CLI::App& app) {
  std::string options, words;
  for (const CLI::App* sub : subcommands(app))
    options += fmt::format("    {}) options='{}' ;;\n", sub->get_name(), long_names(*sub));
  std::set<std::string> told;  // options that were described for an earlier command
  std::vector<const CLI::App*> commands = subcommands(app);
  commands.push_back(&app);
  for (const CLI::App* command : commands)
    for (const CLI::Option* option : command->get_options())
      if (const std::string known = words_of(*option); !known.empty())
        for (const std::string& name : option->get_lnames())
          if (told.insert(name).second)
            words += fmt::format("    --{}) COMPREPLY=($(compgen -W '{}' -- \"$word\")); return ;;\n", name,
                                 known);
  return fmt::format(
      "# bash completion for collarmesh\n_collarmesh() {{\n  local word=${{COMP_WORDS[COMP_CWORD]}} "
      "before=${{COMP_WORDS[COMP_CWORD-1]}} options\n  COMPREPLY=()\n  case $before in\n{}  esac\n"
      "  case ${{COMP_WORDS[1]}} in\n{}    *) options='{}' ;;\n  esac\n"
      "  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n  else\n"
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
      "    if [ \"$COMP_CWORD\" -eq 1 ]; then COMPREPLY+=($(compgen -W '{}' -- \"$word\")); fi\n  fi\n}}\n"
      "complete -o filenames -F _collarmesh collarmesh\n",
      words, options, long_names(app), names_of_subcommands(app));
}

/// Returns the options as arguments of zsh's `_arguments`: '*--name[description]:value's description:action'.
std::string zsh_arguments(const CLI::App& app, const std::string& indent) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    std::string explained = short_text(option->get_description());
    for (std::size_t at = 0; (at = explained.find_first_of("[]", at)) != std::string::npos; at += 2)
      explained.insert(at, "\\");
    std::string value;
    if (takes_value(*option)) {
      const std::string words = words_of(*option);
      const std::string type =
          words.empty() && !option->get_type_name().empty() ? option->get_type_name() : "value";
      value = fmt::format(":{}:{}", type,
                          !words.empty()        ? "(" + words + ")"
                          : takes_file(*option) ? "_files"
                                                : " ");
    }
    const auto add = [&](const std::string& name) {
      text += indent + quoted_text(fmt::format("*{}[{}]{}", name, explained, value), false) + "\n";
    };
    for (const std::string& name : option->get_snames()) add("-" + name);
    for (const std::string& name : option->get_lnames()) add("--" + name);
  }
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* sub : subcommands(app)) {
    const std::string explained = short_text(sub->get_description());
    commands += "    " + quoted_text(fmt::format("{}:{}", sub->get_name(), explained), false) + "\n";
    cases +=
        fmt::format("    {}) arguments=(\n{}      ) ;;\n", sub->get_name(), zsh_arguments(*sub, "      "));
  }
  return fmt::format(
      "#compdef collarmesh\n_collarmesh_first() {{\n  local -a commands=(\n{}  )\n"
      "  _describe -t commands command commands\n  _files\n}}\n"
      "_collarmesh() {{\n  local -a arguments\n  case ${{words[2]}} in\n{}    *) arguments=(\n{}      ) ;;\n"
      "  esac\n  _arguments $arguments '1: :_collarmesh_first' '*:file:_files'\n}}\n_collarmesh \"$@\"\n",
      commands, cases, zsh_arguments(app, "      "));
}

std::string fish_options(const CLI::App& app, const std::string& condition) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    std::string names;
    for (const std::string& name : option->get_snames()) names += " -s " + name;
    for (const std::string& name : option->get_lnames()) names += " -l " + name;
    if (names.empty()) continue;
    if (const std::string words = words_of(*option); !words.empty())
      names += fmt::format(" -x -a '{}'", words);
    else if (takes_value(*option))
      names += takes_file(*option) ? " -r -F" : " -x";
    fmt::format_to(std::back_inserter(text), "complete -c collarmesh -n {}{} -d {}\n",
                   quoted_text(condition, true), names,
                   quoted_text(short_text(option->get_description()), true));
  }
  return text;
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion for collarmesh\n";
  for (const CLI::App* sub : subcommands(app))
    fmt::format_to(std::back_inserter(text), "complete -c collarmesh -n __fish_use_subcommand -a {} -d {}\n",
                   sub->get_name(), quoted_text(short_text(sub->get_description()), true));
  text += fish_options(app, "not __fish_seen_subcommand_from " + names_of_subcommands(app));
  for (const CLI::App* sub : subcommands(app))
    text += fish_options(*sub, "__fish_seen_subcommand_from " + sub->get_name());
  return text;
}

}  // namespace

std::string completion(const CLI::App& app, std::string_view shell) {
  if (shell == "bash") return bash_completion(app);
  if (shell == "zsh") return zsh_completion(app);
  if (shell == "fish") return fish_completion(app);
  return {};
}

}  // namespace collarmesh::cli
