#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "collarmesh/periodic.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::report {

/// A line for each pair.
std::string periodic_text(const PeriodicReport& report);
/// With the motion of each pair, and its nodes as rows of the mesh's points, from 0.
nlohmann::ordered_json periodic_json(const PeriodicReport& report, const TetMesh& mesh);

}  // namespace collarmesh::report
