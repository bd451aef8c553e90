#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace collarmesh::report {

/// Returns JSON as text. Bytes of file names that are not UTF-8 become replacement characters.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace collarmesh::report
