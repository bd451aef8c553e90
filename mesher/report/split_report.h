#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "collarmesh/split.h"

namespace collarmesh::report {

/// Returns lines about the patches, about the split nodes, and about cohesive elements, if any.
std::string split_text(const SplitReport& report);
nlohmann::ordered_json split_json(const SplitReport& report);

}  // namespace collarmesh::report
