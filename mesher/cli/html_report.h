#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::cli {

/// A run as one page that needs no network: `report` (`run_json`) to read, and a view of the mesh that turns
/// and cuts. Of large meshes the view holds the tets at faces and those around the three middle planes.
std::string html_report(const nlohmann::ordered_json& report, const TetMesh& mesh);

/// Is a report with this path to be a page?
bool is_html(const std::string& path);

}  // namespace collarmesh::cli
