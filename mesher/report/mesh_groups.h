#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::report {

/// The triangles, or edges, of a mesh that have one tag.
struct MeshGroup {
  Tag tag = 0;
  std::string name;       ///< that it was given; empty: none
  std::size_t cells = 0;  ///< triangles or edges
  double measure = 0;     ///< their area or length
  Point where;            ///< the centre of the largest one
};

/// By tag, of the corners. Cost: linear.
std::vector<MeshGroup> patches_of(const TetMesh& mesh);
std::vector<MeshGroup> curves_of(const TetMesh& mesh);

/// How a tag is called, where it has a name: the one that it was given, or that of a CAD shape; else empty.
std::string name_of(const TagNames& given, GroupNames names, std::size_t dimension, Tag tag);

/// How regions are called, by their numbers: those whose tag has a name.
std::map<Index, std::string> names_of_regions(const TetMesh& mesh);

/// For people, a line each, the first ones if there are very many; and for programs.
std::string groups_text(const TetMesh& mesh);
nlohmann::ordered_json groups_json(const std::vector<MeshGroup>& groups, const char* cells,
                                   const char* measure);

}  // namespace collarmesh::report
