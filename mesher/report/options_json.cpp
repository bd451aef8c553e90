#include "report/options_json.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace collarmesh::report {

using Json = nlohmann::ordered_json;

namespace {

const char* name_of_kind(Option::Kind kind) {
  switch (kind) {
    case Option::Kind::flag: return "flag";
    case Option::Kind::choice: return "choice";
    case Option::Kind::count: return "count";
    case Option::Kind::number: return "number";
    case Option::Kind::text: return "text";
    case Option::Kind::texts: return "texts";
    case Option::Kind::sizes: return "sizes";
  }
  return "unknown";
}

const char* name_of_unit(Option::Unit unit) {
  switch (unit) {
    case Option::Unit::length: return "length";
    case Option::Unit::degrees: return "degrees";
    case Option::Unit::of_diagonal: return "diagonal";
    case Option::Unit::seconds: return "seconds";
    case Option::Unit::bytes: return "bytes";
    default: return "";
  }
}

/// Makes an object from distinct keys, without comparing each key with all earlier ones.
Json by_tag(const std::map<Tag, double>& sizes) {
  Json::object_t object;
  for (const auto& [tag, size] : sizes) object.emplace_back(std::to_string(tag), size);
  return object;
}

Json value_json(const Option& option, const RunOptions& options) {
  const bool may_be_nothing = !option.default_text.empty() || option.kind() == Option::Kind::text;
  return std::visit(
      [may_be_nothing]<class T>(const T& value) -> Json {
        if constexpr (std::is_same_v<T, std::map<Tag, double>>)
          return by_tag(value);
        else
          return may_be_nothing && value == T{} ? Json(nullptr) : Json(value);
      },
      option.get(options));
}

Json takers_of(const Option& option) {
  Json takers = Json::array();
  for (const auto& [command, name] :
       {std::pair(Option::mesh, "mesh"), std::pair(Option::check, "check"), std::pair(Option::info, "info"),
        std::pair(Option::convert, "convert"), std::pair(Option::repair, "repair"),
        std::pair(Option::remesh, "remesh"), std::pair(Option::programs, "programs"),
        std::pair(Option::ranks, "ranks")})
    if (option.is_for(command)) takers.push_back(name);
  return takers;
}

}  // namespace

Json options_json(const RunOptions& options) {
  Json json;
  for (const Option& option : option_table())
    if (option.is_for(Option::mesh) && option.is_for(Option::programs))
      json[option.key()] = value_json(option, options);
  return json;
}

Json option_table_json() {
  Json table = Json::array();
  for (const Option& option : option_table())
    table.push_back({{"name", option.name},
                     {"key", option.key()},
                     {"letter", option.letter == 0 ? Json(nullptr) : Json(std::string(1, option.letter))},
                     {"kind", name_of_kind(option.kind())},
                     {"value_name", option.value_name},
                     {"words", option.words},
                     {"unit", name_of_unit(option.unit)},
                     {"low", option.low},
                     {"high", std::isfinite(option.high) ? Json(option.high) : Json(nullptr)},
                     {"zero", option.zero},
                     {"default", value_json(option, {})},
                     {"default_text", option.default_value()},
                     {"group", option.group},
                     {"help", option.help},
                     {"details", option.details},
                     {"takers", takers_of(option)}});
  return table;
}

}  // namespace collarmesh::report
