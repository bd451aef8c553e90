#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/file_writer.h"
#include "io/msh_entities.h"

namespace collarmesh::io {

/// A link of Gmsh: the mesh of an entity is the image of the mesh of another entity, its master.
struct MshLink {
  std::size_t dimension = 2;
  int entity = 0, master = 0;               ///< numbers of entities
  TetMesh::Motion motion;                   ///< takes the master to the entity
  std::vector<std::array<Index, 2>> nodes;  ///< nodes of the entity and its boundary, each with the node
                                            ///< of the master whose image it is
};

/// Finds the links of points, curves and surfaces of the second groups of periodic faces, in this order. Gmsh
/// allows one master per entity, so only the first link of an entity is kept. Links that would form a cycle
/// are left out.
std::vector<MshLink> find_msh_links(const TetMesh& mesh, const MshEntities& entities);

/// Writes the section $Periodic, unless it is empty. A keyword precedes the matrix in versions before 4, the
/// number of its values in later ones.
void write_msh_links(FileWriter& out, const std::vector<MshLink>& links, int version);

}  // namespace collarmesh::io
