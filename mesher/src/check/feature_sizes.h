#pragma once

#include <vector>

#include "check/subject.h"

namespace collarmesh::checks {

/// Returns the nodes of a face of a mesh of second order.
CurvedTriangle curved_face(const TetMesh& mesh, Index face);

/// Return the length of an edge and the area of a face of a mesh, curved as they are.
double length_of_edge(const TetMesh& mesh, Index edge);
double area_of_face(const TetMesh& mesh, Index face);

/// Returns the areas of patches and the lengths of curves in the mesh. Precondition: subject.match is filled
/// in.
ShapeMeasures feature_sizes(const Subject& subject);

/// Returns the sizes of the complex, those of the exact geometry where they are known.
ShapeMeasures input_sizes(const Subject& subject);

/// Puts into the report the sizes of the features up to a dimension, 1 or 2, in the complex and in a mesh
/// that has no tets, and the median length of the edges of this mesh.
void measure_without_tets(const Subject& subject, int dimension, CheckReport& report);

/// Finds patches, curves and vertices of the complex that a mesh without tets, of dimension 1 or 2, does not
/// have.
void check_present(const Subject& subject, int dimension, Findings& findings);

}  // namespace collarmesh::checks
