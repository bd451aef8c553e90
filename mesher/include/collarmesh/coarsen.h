#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct CoarsenReport {
  std::size_t tets_before = 0, tets_after = 0;
  std::size_t contracted_edges = 0;  ///< edge collapses, including those that needed repairs
  std::size_t repaired = 0;          ///< collapses that needed changes of the tets around them
  double seconds = 0;
  bool cancelled = false;  ///< the mesh is valid and partly coarsened
};

/// Coarsens the mesh to as few tets as the sizes ask for. Collapses edges shorter than 0.8 times the target
/// edge length there (0.75 inside regions), within their features, unless a new edge would exceed 1.5 times
/// that length or be shorter than all edges around it.
/// The radius-edge bound alone makes tets as small as the thinnest wall and the sharpest wedge require. This
/// function therefore lets thin tets exceed that bound. Their dihedral angles are at least `thin_angle`, and
/// their dihedral and face angles at most 150 degrees (the maximum-angle condition: Babuska and Aziz 1976,
/// Krizek 1992). Afterwards collars are the tets that touch a crease; their angles are at most
/// `collar_angle`. If a collapse makes tets miss their bounds, it is repaired at once, by edge removal and by
/// moving vertices, or undone. All other guarantees still hold; planar patches stay planar, smooth patches
/// and curves stay within the distance.
/// Preconditions: `mesh` comes from `generate` for `plc` with the options `made_with`, and is of first order.
/// Guarantee: same input and options, same mesh. Throws OptionError for an angle out of range. Cost: linear
/// in the tets, with local changes: some microseconds for each tet that is removed, and several times that
/// where repairs fail.
CoarsenReport coarsen(TetMesh& mesh, const Plc& plc, const MeshOptions& made_with,
                      const Execution& execution = {});

}  // namespace collarmesh
