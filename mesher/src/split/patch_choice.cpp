#include "split/patch_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "collarmesh/error.h"

namespace collarmesh::splitting {

namespace {

/// Reads "7", "patch_7" or "Face7".
std::optional<Tag> number_in(std::string_view text) {
  for (const std::string_view prefix : {"patch_", "Face"})
    if (text.starts_with(prefix)) {
      text.remove_prefix(prefix.size());
      break;
    }
  Tag tag = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), tag);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(tag) : std::nullopt;
}

/// Returns the tags that a text names; a name comes before a number.
std::set<Tag> tags_of(const std::string& text, const TagNames& names) {
  std::set<Tag> tags;
  for (const auto& [tag, name] : names.of(2))
    if (name == text) tags.insert(tag);
  if (tags.empty())
    if (const std::optional<Tag> number = number_in(text)) tags.insert(*number);
  return tags;
}

std::string internal_patches(const TagNames& names, const std::vector<Candidate>& all) {
  constexpr std::size_t longest = 100;
  std::set<Tag> tags;
  for (const Candidate& candidate : all)
    if (candidate.is_internal()) tags.insert(candidate.tag);
  std::string list;
  for (const Tag tag : tags) {
    if (list.size() > longest) return list + ", ...";
    const std::string* const name = names.find(2, tag);
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", tag,
                        name == nullptr ? "" : fmt::format(" ({})", *name));
  }
  return list.empty() ? "there are none" : "they are " + list;
}

}  // namespace

PatchChoice::PatchChoice(const SplitOptions& options, const TagNames& names,
                         const std::vector<Candidate>& all)
    : keep_apart_(options.keep_apart) {
  for (const std::string& text : options.patches) {
    const std::set<Tag> tags = tags_of(text, names);
    const auto named = [&](const Candidate& candidate) { return tags.contains(candidate.tag); };
    if (std::none_of(all.begin(), all.end(), named))
      throw OptionError(fmt::format("split: no patch is called '{}'; patches inside can be split, {}", text,
                                    internal_patches(names, all)));
    if (std::none_of(all.begin(), all.end(),
                     [&](const Candidate& each) { return named(each) && each.is_internal(); }))
      throw OptionError(fmt::format("split: patch '{}' lies on the boundary; patches inside can be split, {}",
                                    text, internal_patches(names, all)));
    tags_.insert(tags.begin(), tags.end());
  }
  if (keep_apart_ &&
      std::none_of(all.begin(), all.end(), [](const Candidate& each) { return each.is_interface(); }))
    throw OptionError("keep-apart: no two regions touch, so there is nothing to keep apart");
}

}  // namespace collarmesh::splitting
