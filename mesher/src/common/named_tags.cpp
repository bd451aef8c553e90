#include "common/named_tags.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

namespace collarmesh {

namespace {

std::optional<Tag> number_in(std::string_view text, std::size_t dimension) {
  if (dimension == 2)
    for (const std::string_view prefix : {"patch_", "Face"})
      if (text.starts_with(prefix)) {
        text.remove_prefix(prefix.size());
        break;
      }
  Tag tag = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), tag);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(tag) : std::nullopt;
}

}  // namespace

std::set<Tag> tags_named(const std::string& text, std::size_t dimension, const TagNames& names) {
  std::set<Tag> tags;
  for (const auto& [tag, name] : names.of(dimension))
    if (name == text) tags.insert(tag);
  if (tags.empty())
    if (const std::optional<Tag> number = number_in(text, dimension)) tags.insert(*number);
  return tags;
}

std::string list_of_patches(const std::set<Tag>& tags, const TagNames& names) {
  constexpr std::size_t longest = 100;
  std::string list;
  for (const Tag tag : tags) {
    if (list.size() > longest) return list + ", ...";
    const std::string* const name = names.find(2, tag);
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", tag,
                        name == nullptr ? "" : fmt::format(" ({})", *name));
  }
  return list;
}

std::string list_of_patches(const Plc& plc) {
  std::set<Tag> tags;
  for (const Plc::Patch& patch : plc.patches) tags.insert(patch.tag);
  return list_of_patches(tags, plc.names);
}

}  // namespace collarmesh
