#pragma once

#include <string>
#include <vector>

namespace collarmesh::files {

/// Adds single names, such as "fixed=11", "walls=1,2", "rim=curve:4", "steel=region:1", to a text of names
/// (`name_features`). Returns the new text. If the text is not JSON, returns it unchanged, and its reader
/// reports the error. Throws OptionError.
std::string with_names(const std::string& text, const std::vector<std::string>& given);

}  // namespace collarmesh::files
