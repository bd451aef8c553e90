#pragma once

#include <string>
#include <vector>

namespace collarmesh::files {

/// The text of names (`name_features`) with those that were given one by one, as "fixed=11", "walls=1,2",
/// "rim=curve:4", "steel=region:1". A text that is no JSON is returned as it is, for its reader to say what
/// is wrong with it. Throws OptionError.
std::string with_names(const std::string& text, const std::vector<std::string>& given);

}  // namespace collarmesh::files
