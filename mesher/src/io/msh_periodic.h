#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/file_writer.h"
#include "io/msh_entities.h"

namespace collarmesh::io {

/// An entity of Gmsh whose mesh is the image of another one's.
struct MshLink {
  std::size_t dimension = 2;
  int entity = 0, master = 0;               ///< numbers of entities
  TetMesh::Motion motion;                   ///< takes the master to the entity
  std::vector<std::array<Index, 2>> nodes;  ///< pairs of a node of the entity, including its boundary, and
                                            ///< one of the master
};

/// Finds the links of points, curves and surfaces on the second sides of periodic faces, in this order. Gmsh
/// allows one master per entity, so an entity that has several gets the first one.
std::vector<MshLink> find_msh_links(const TetMesh& mesh, const MshEntities& entities);

/// Writes the section $Periodic, unless it is empty. In formats before 4 a keyword precedes the matrix.
void write_msh_links(FileWriter& out, const std::vector<MshLink>& links, int version);

}  // namespace collarmesh::io
