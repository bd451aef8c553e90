#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "collarmesh/split.h"

namespace collarmesh::report {

/// Returns a line for each patch, and one for its nodes.
std::string split_text(const SplitReport& report);
nlohmann::ordered_json split_json(const SplitReport& report);

}  // namespace collarmesh::report
