#pragma once

#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/tet_sides.h"
#include "io/face_finder.h"

namespace collarmesh::io {

/// The side of a tet opposite one of its corners.
struct SideOfTet {
  Index tet = none;
  unsigned opposite = 0;  ///< index of the corner
};

/// Finds a side of a tet for each face: of the tet behind it, if there is one.
inline std::vector<SideOfTet> sides_of_faces(const TetMesh& mesh) {
  std::vector<SideOfTet> found(mesh.faces.size());
  FaceFinder finder(mesh.faces);
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceFinder::Triangle outward = side_corners(mesh.tets[t], corner);
      const Index face = finder.find(outward);
      if (face != none && (FaceFinder::alike(mesh.faces[face], outward) || found[face].tet == none))
        found[face] = {t, corner};
    }
  return found;
}

}  // namespace collarmesh::io
