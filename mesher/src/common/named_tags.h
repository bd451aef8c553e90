#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "collarmesh/plc.h"
#include "collarmesh/tag_names.h"

namespace collarmesh {

/// Returns the tags of the features of a dimension that have this text as their name. If there are none, the
/// text may be a number: "7", and for patches also "patch_7" and "Face7".
std::set<Tag> tags_named(const std::string& text, std::size_t dimension, const TagNames& names);

/// Returns these tags of patches with their names, for a message; only the first ones if they are many.
std::string list_of_patches(const std::set<Tag>& tags, const TagNames& names);
/// Returns the tags of all patches of a complex with their names, for a message; only the first if they are
/// many.
std::string list_of_patches(const Plc& plc);

}  // namespace collarmesh
