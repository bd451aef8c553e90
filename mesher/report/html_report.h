#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/shown_mesh.h"

namespace collarmesh::report {

/// A run as one page that needs no network: `report` (`run_json`) to read, and a view of the mesh, in the
/// same unit of length, that turns and cuts.
std::string html_report(const nlohmann::ordered_json& report, const ShownMesh& shown);

/// Is a report with this path to be a page?
bool is_html(const std::string& path);

}  // namespace collarmesh::report
