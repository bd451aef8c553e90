#pragma once

#include <cstdint>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "report/worst_tets.h"

namespace collarmesh::report {

/// The part of a mesh that a page shows.
struct ShownMesh {
  struct ShownWorst {
    Index tet;                 ///< index among the shown tets
    double smallest, largest;  ///< dihedral angles, degrees
    Point where;               ///< centre of the tet
  };

  bool complete = true;               ///< whether all tets of the mesh are included
  Point centre;                       ///< centre of the bounding box
  std::vector<float> points;          ///< three numbers for each, relative to the centre
  std::vector<std::uint32_t> tets;    ///< four corners for each
  std::vector<std::uint32_t> faces;   ///< on patches: three corners and an index into `face_tags` for each
  std::vector<Tag> face_tags;         ///< sorted
  std::vector<std::uint16_t> region;  ///< by tet
  std::vector<std::uint8_t> marks;    ///< by tet: sum of 1 in a collar, 2 thin, 8 in odd, 16 in even layers
  std::vector<ShownWorst> worst;      ///< the given worst tets
};

/// Returns all faces of a mesh, and all tets if there are at most `most`. If there are more, returns the tets
/// with a side among the faces, those that meet the planes through the centre orthogonal to an axis, and the
/// worst ones. Cost: linear.
ShownMesh shown_mesh(const TetMesh& mesh, const std::vector<WorstTet>& worst, std::size_t most = 100000);

}  // namespace collarmesh::report
