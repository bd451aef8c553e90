#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/shown_mesh.h"
#include "report/shown_trace.h"

namespace collarmesh::report {

/// Returns an HTML page about a run; the page needs no network. It has `report` (`run_json`) as text, and a
/// view of the mesh that can be turned and cut, in the report's unit of length. The view also shows the steps
/// of `trace`.
std::string html_report(const nlohmann::ordered_json& report, const ShownMesh& shown,
                        const std::vector<ShownStep>& trace = {});

/// Returns whether a report with this path is an HTML page, by its extension.
bool is_html(const std::string& path);

}  // namespace collarmesh::report
