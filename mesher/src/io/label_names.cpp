#include "io/label_names.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "io/number_text.h"

namespace collarmesh::io {

std::string word(std::string text) {
  for (char& c : text)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-')) c = '_';
  return text;
}

std::string capital_word(std::string text) {
  text = word(std::move(text));
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - ('a' - 'A'));
  return text;
}

std::string word_name(const TetMesh& mesh, std::size_t dimension, Tag tag) {
  return word(group_name(mesh, dimension, tag));
}

std::string capital_name(const TetMesh& mesh, std::size_t dimension, Tag tag) {
  const std::string name = capital_word(group_name(mesh, dimension, tag));
  return !name.empty() && name.front() >= 'A' && name.front() <= 'Z' ? name : "N_" + name;
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

namespace {

/// Cuts a text to at most `longest` bytes, but not within a UTF-8 character.
std::string cut(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

}  // namespace

std::string DistinctNames::add(const std::string& name) {
  std::string tried = cut(name, longest_);
  for (std::size_t k = 2; !known_.insert(tried).second; ++k) {
    const std::string number = fmt::format("_{}", k);
    tried = cut(name, longest_ - number.size()) + number;
  }
  return tried;
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
