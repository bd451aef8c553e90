#pragma once

#include <string>
#include <vector>

#include "collarmesh/merge_soups.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::report {

/// Describe the data of a soup or a mesh that a format cannot store; empty if nothing is lost.
std::vector<std::string> lost_by(const std::string& format, const PolygonSoup& soup);
std::vector<std::string> lost_by(const std::string& format, const TetMesh& mesh);

/// Returns whether this format of meshes can store names of groups.
bool keeps_names(const std::string& format);

// Lines of text for display:
std::string soup_text(const std::string& path, const PolygonSoup& soup);
std::string tet_mesh_text(const std::string& path, const TetMesh& mesh);
std::string merge_text(const MergeReport& report);
/// Describes the changes made by the builder of a complex.
std::string cleanup_text(const Plc::Cleanup& cleanup);
std::string losses_text(const std::vector<std::string>& losses);

}  // namespace collarmesh::report
