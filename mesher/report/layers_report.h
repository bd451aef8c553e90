#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "collarmesh/layers.h"

namespace collarmesh::report {

/// Returns a line for each patch with layers, one for each reason why layers are lower than asked for, and
/// one that counts the cells.
std::string layers_text(const LayersReport& report);
nlohmann::ordered_json layers_json(const LayersReport& report);

}  // namespace collarmesh::report
