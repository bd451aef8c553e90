#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::report {

/// All triangles and quadrangles of a mesh, or all its edges, that have a certain tag.
struct MeshGroup {
  Tag tag = 0;
  std::string name;       ///< given name; empty: none
  std::size_t cells = 0;  ///< number of triangles or edges
  std::size_t quads = 0;  ///< number of quadrangles
  double measure = 0;     ///< area or length of all cells
  Point where;            ///< centre of the largest cell
};

/// Return the groups of faces or of edges, sorted by tag. Cells of second order are measured as straight
/// ones. Cost: linear.
std::vector<MeshGroup> patches_of(const TetMesh& mesh);
std::vector<MeshGroup> curves_of(const TetMesh& mesh);

/// Returns the name of a tag: the given name or, with GroupNames::cad, the one in the CAD shape ("Face3");
/// empty if it has neither.
std::string name_of(const TagNames& given, GroupNames names, std::size_t dimension, Tag tag);

/// Returns the names of regions by their numbers, for regions whose tag has a name.
std::map<Index, std::string> names_of_regions(const TetMesh& mesh);

/// Describe the groups: as text, one per line, only the first ones if there are very many; and as JSON.
std::string groups_text(const TetMesh& mesh);
nlohmann::ordered_json groups_json(const std::vector<MeshGroup>& groups, const char* cells,
                                   const char* measure);

}  // namespace collarmesh::report
