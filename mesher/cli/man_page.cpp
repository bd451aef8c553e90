#include "man_page.h"

#include <fmt/format.h>

#include <iterator>
#include <string_view>
#include <vector>

#include "command/usage_error.h"
#include "help_text.h"

namespace collarmesh::cli {

namespace {

/// Escapes backslashes and hyphens for roff, and dots and apostrophes at the beginning of a line, so that
/// they are printed as they are.
std::string roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n'))
      result += std::string("\\&") + c;
    else
      result += c;
  }
  return result;
}

void add_option(std::string& text, const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames())
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff("-" + name));
  for (const std::string& name : option.get_lnames())
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff("--" + name));
  if (names.empty()) names = fmt::format("\\fI{}\\fR", roff(option.get_name()));
  const std::string type = option.get_expected_max() == 0 ? std::string() : option.get_type_name();
  fmt::format_to(
      std::back_inserter(text), ".TP\n{}{}\n{}{}\n", names,
      type.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(type)), roff(option.get_description()),
      option.get_default_str().empty() ? "" : fmt::format(" (default: {})", roff(option.get_default_str())));
}

void add_options(std::string& text, const CLI::App& app, const char* heading) {
  for (const std::string& group : app.get_groups()) {
    const auto members =
        app.get_options([&](const CLI::Option* option) { return option->get_group() == group; });
    if (members.empty()) continue;
    fmt::format_to(std::back_inserter(text), "{} {}\n", heading, roff(group));
    for (const CLI::Option* option : members) add_option(text, *option);
  }
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version, const std::string& footer) {
  std::string text =
      fmt::format(".TH COLLARMESH 1 \"\" \"collarmesh {}\"\n.SH NAME\ncollarmesh \\- {}\n.SH SYNOPSIS\n",
                  version, roff("tetrahedral meshes of surfaces, CAD shapes and complexes, certified"));
  const auto subs = subcommands(app);
  std::vector<std::string> usages{usage_of("")};
  for (const CLI::App* sub : subs) usages.push_back(usage_of(sub->get_name()));
  for (const std::string& usage : usages)
    fmt::format_to(std::back_inserter(text), "{} [options]\n.br\n", roff(usage));
  text += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n.SH OPTIONS\n";
  add_options(text, app, ".SS");
  for (const CLI::App* sub : subs) {
    fmt::format_to(std::back_inserter(text), ".SH COLLARMESH {}\n{}\n", roff(sub->get_name()),
                   roff(sub->get_description()));
    add_options(text, *sub, ".SS");
  }
  text += ".SH NOTES\n.nf\n" + roff(footer) + "\n.fi\n";
  return text;
}

}  // namespace collarmesh::cli
