#include "io/label_names.h"

#include <fmt/format.h>

#include <limits>

#include "io/number_text.h"

namespace collarmesh::io {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return result;
}

std::string group_name(GroupNames names, std::size_t dimension, Tag tag, std::string_view minus) {
  std::string digits = fmt::format("{}", tag);
  if (tag < 0) digits = fmt::format("{}{}", minus, digits.substr(1));
  const auto& prefixes = names == GroupNames::cad ? cad_name_prefix : group_name_prefix;
  return fmt::format("{}{}", prefixes[dimension], digits);
}

std::string group_name(const TetMesh& mesh, std::size_t dimension, Tag tag, std::string_view minus) {
  const std::string* given = mesh.names.find(dimension, tag);
  if (given == nullptr) return group_name(mesh.group_names, dimension, tag, minus);
  std::string name = *given;
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '"') c = '_';
  return name;
}

std::string word_name(const TetMesh& mesh, std::size_t dimension, Tag tag) {
  std::string name = group_name(mesh, dimension, tag);
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-')) c = '_';
  return name;
}

std::string capital_name(const TetMesh& mesh, std::size_t dimension, Tag tag) {
  std::string name = word_name(mesh, dimension, tag);
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - ('a' - 'A'));
  return name;
}

std::optional<Tag> tag_of_group_name(std::size_t dimension, std::string_view name) {
  const std::string lower = lower_case(name);
  std::string prefix(group_name_prefix[dimension]);
  if (!lower.starts_with(prefix)) prefix = lower_case(cad_name_prefix[dimension]);
  if (!lower.starts_with(prefix)) return std::nullopt;
  std::string digits = lower.substr(prefix.size());
  constexpr std::string_view minus = "minus_";
  if (digits.starts_with(minus)) digits.replace(0, minus.size(), "-");
  Tag tag = 0;
  if (!parse(digits, tag)) return std::nullopt;
  return tag;
}

bool is_given_name(std::size_t dimension, std::string_view name) {
  return !tag_of_group_name(dimension, name) || !lower_case(name).starts_with(group_name_prefix[dimension]);
}

Tag GroupTags::find(std::size_t dimension, const std::string& name) {
  const auto [known, added] = known_[dimension].try_emplace(name, 0);
  if (added) {
    Tag& next = next_[dimension];
    known->second = tag_of_group_name(dimension, name).value_or(next);
    if (known->second >= next && known->second < std::numeric_limits<Tag>::max()) next = known->second + 1;
  }
  return known->second;
}

}  // namespace collarmesh::io
