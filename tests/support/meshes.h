#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

/// Correct meshes that no mesher made, for testing the judges.
namespace collarmesh::testing {

struct MeshedComplex {
  Plc plc;
  TetMesh mesh;
};

/// Returns the unit box cut into n^3 cubes of six tets each (Kuhn, Some combinatorial lemmas in topology,
/// 1960).
MeshedComplex meshed_box(Index n);

/// Returns two_boxes(), each box cut like meshed_box(n).
MeshedComplex meshed_two_boxes(Index n);

/// Returns a mesh of box_with_dangling_facet(0.5): a free facet inside. Precondition: n is a multiple of 4.
MeshedComplex meshed_box_with_facet(Index n);

/// Returns the unit ball: the mesh joins an icosphere of this frequency to its centre; the complex is an
/// icosphere with `finer` times the frequency.
MeshedComplex meshed_ball(unsigned frequency, unsigned finer);

/// Returns a cylinder of radius and height 1: the mesh joins its surface to its centre; the complex has
/// `finer` times as many segments. The complex has smooth closed curves, and planar patches with a smooth
/// border.
MeshedComplex meshed_cylinder(unsigned segments, unsigned finer);

/// Returns the same cylinder and complex, but without a vertex in the middle of a cap: each cap is a fan of
/// triangles around a point of its circle, so that two of them have two sides on the circle.
MeshedComplex meshed_cylinder_with_ears(unsigned segments, unsigned finer);

/// Returns the mesh as it is when read from a file: without features.
TetMesh without_features(TetMesh mesh);

}  // namespace collarmesh::testing
