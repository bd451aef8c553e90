#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::adapting {

/// A mesh and the complex formed by its own boundaries, interfaces, facets and curves, with the features of
/// this complex at all its points, faces and edges.
struct MeshComplex {
  Plc plc;
  TetMesh mesh;  ///< the mesh of `CornerMesh`, with the edges of all curves
};

/// The part of a mesh that remeshing keeps: its tets and their corners, and the corners of its faces and
/// edges.
struct CornerMesh {
  TetMesh mesh;
  std::vector<Index> given;  ///< by point: its index in the whole mesh
};

/// Returns the part of a mesh that remeshing keeps. Throws PlcError for a mesh without tets, and for faces
/// and edges with nodes that belong to no tet.
CornerMesh corners_of(const TetMesh& mesh);

/// Builds the complex of a mesh. Its facets are the sides of tets at a boundary or between two regions, and
/// listed faces inside a region. If the mesh lists edges wherever facets end, branch or change tags, these
/// edges are its curves; otherwise folds above `options.feature_angle` are curves, too. Connected tets of one
/// region form a region of the complex. Throws PlcError if the mesh does not conform, or if boundaries of its
/// regions are inverted, one-sided or without area. Cost: O(n log n).
MeshComplex complex_of(const TetMesh& mesh, const PlcOptions& options);

}  // namespace collarmesh::remeshing::adapting
