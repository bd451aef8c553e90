#include "files/named_features.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/geometry.h"
#include "io/number_text.h"

namespace collarmesh::files {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<std::string_view, const char*>, 3> groups{
    {{"patch:", "patches"}, {"curve:", "curves"}, {"region:", "regions"}}};

/// A single name, such as "walls=1,2", which is added to the text of names.
struct Given {
  std::string name, group = "patches";
  std::vector<Tag> numbers;
};

[[noreturn]] void fail(const std::string& text) {
  throw OptionError(fmt::format(
      "name: '{}' is not NAME=NUMBER, NAME=NUMBER,NUMBER, NAME=curve:NUMBER or NAME=region:NUMBER", text));
}

Given read(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) fail(text);
  Given given{text.substr(0, equals), "patches", {}};
  std::string_view rest = std::string_view(text).substr(equals + 1);
  for (const auto& [prefix, group] : groups)
    if (rest.starts_with(prefix)) {
      given.group = group;
      rest.remove_prefix(prefix.size());
      break;
    }
  while (true) {
    const std::size_t comma = rest.find(',');
    Tag number = 0;
    if (!io::parse(rest.substr(0, comma), number)) fail(text);
    given.numbers.push_back(number);
    if (comma == std::string_view::npos) return given;
    rest.remove_prefix(comma + 1);
  }
}

void add(const Given& given, Json& names) {
  Json& group = names[given.group];
  if (!group.is_null() && !group.is_object()) return;  // leave this error to the reader of names
  Json& members = group[given.name];
  if (members.is_null())
    members = Json::array();
  else if (!members.is_array())
    members = Json::array({members});
  for (const Tag number : given.numbers) members.push_back(number);
}

}  // namespace

std::string with_names(const std::string& text, const std::vector<std::string>& given) {
  if (given.empty()) return text;
  Json names = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  if (!names.is_object()) return text;
  for (const std::string& each : given) add(read(each), names);
  return names.dump();
}

}  // namespace collarmesh::files
