#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "collarmesh/periodic.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::report {

/// Returns a line for each pair of groups of periodic faces, and one about changes that made them alike.
std::string periodic_text(const PeriodicReport& report);
/// Returns the report with the motion and the node pairs of each pair of groups. Nodes are indices of the
/// mesh's points, from 0.
nlohmann::ordered_json periodic_json(const PeriodicReport& report, const TetMesh& mesh);

}  // namespace collarmesh::report
