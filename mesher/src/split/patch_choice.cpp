#include "split/patch_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "collarmesh/error.h"
#include "common/named_tags.h"

namespace collarmesh::splitting {

namespace {

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
    const std::set<Tag> tags = tags_named(text, 2, names);
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
