#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "collarmesh/layers.h"

namespace collarmesh::report {

/// Returns a line for each wall, one for each reason of lower layers, and one for the cells.
std::string layers_text(const LayersReport& report);
nlohmann::ordered_json layers_json(const LayersReport& report);

}  // namespace collarmesh::report
