#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/shown_mesh.h"
#include "report/shown_trace.h"

namespace collarmesh::report {

/// A run as one page that needs no network: `report` (`run_json`) to read, and a view of the mesh, in the
/// same unit of length, that turns and cuts. `trace`: what the view shows besides, step by step.
std::string html_report(const nlohmann::ordered_json& report, const ShownMesh& shown,
                        const std::vector<ShownStep>& trace = {});

/// Is a report with this path to be a page?
bool is_html(const std::string& path);

}  // namespace collarmesh::report
