#pragma once

#include <vector>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// Returns the nodes of a face of a mesh of second order.
CurvedTriangle curved_face(const TetMesh& mesh, Index face);

/// Return the length of an edge and the area of a face of a mesh, curved if the mesh is of second order.
double length_of_edge(const TetMesh& mesh, Index edge);
double area_of_face(const TetMesh& mesh, Index face);

/// Returns the areas of patches and the lengths of curves in the mesh. Precondition: to_check.match is filled
/// in.
ShapeMeasures feature_sizes(const MeshToCheck& to_check);

/// An area, and the allowed difference of the mesh's area from it.
struct AllowedArea {
  double area, allowed;
};
/// Returns the area of the projection of a patch onto its plane, and the allowed difference. The area depends
/// on the border alone: it is half the sum of dot(normal, cross(a, b)) over all edges ab, and the two sides
/// of each inner edge cancel. So triangles may be tilted if the patch is planar only up to a tolerance, and
/// folded if they are narrower than the tolerance. (The sum of unprojected areas would not do: a tilt by an
/// angle t increases an area by about t^2 / 2, and needles may be tilted by any angle.) Areas may therefore
/// differ by the length of the border times the distance that it may move, and by rounding.
AllowedArea planar_area(const MeshToCheck& to_check, Index patch);

/// Returns the sizes of the features of the exact geometry where known, else of the complex.
ShapeMeasures input_sizes(const MeshToCheck& to_check);

/// Fills in the report for a mesh without tets: the sizes of the features up to a dimension (1 or 2), in the
/// complex and in the mesh, and the median length of the mesh's edges.
void measure_without_tets(const MeshToCheck& to_check, int dimension, CheckReport& report);

/// Finds patches, curves and vertices of the complex that are missing in a mesh without tets, of dimension 1
/// or 2.
void check_present(const MeshToCheck& to_check, int dimension, Findings& findings);

}  // namespace collarmesh::checks
