#pragma once

#include <string>
#include <vector>

namespace collarmesh::files {

/// Returns the text of names (`name_features`) with single names added, such as "fixed=11", "walls=1,2",
/// "rim=curve:4", "steel=region:1". Returns a text that is not JSON as it is, so that its reader reports the
/// error. Throws OptionError.
std::string with_names(const std::string& text, const std::vector<std::string>& given);

}  // namespace collarmesh::files
