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
  int entity = 0, master = 0;               ///< numbers
  TetMesh::Motion motion;                   ///< takes the master to the entity
  std::vector<std::array<Index, 2>> nodes;  ///< of the entity, with its boundary, and of the master
};

/// Points, curves and surfaces on the second sides of periodic faces, in this order. An entity with several
/// masters has the first one, as Gmsh's have one each.
std::vector<MshLink> find_msh_links(const TetMesh& mesh, const MshEntities& entities);

/// Writes the section $Periodic, unless there is nothing in it. Formats before 4 have another row for the
/// matrix.
void write_msh_links(FileWriter& out, const std::vector<MshLink>& links, int version);

}  // namespace collarmesh::io
