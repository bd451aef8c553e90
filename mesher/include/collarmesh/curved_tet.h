#pragma once

#include <array>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The nodes of a tetrahedron of second order: corners a, b, c, d, then the mid-edge nodes of ab, bc, ca, ad,
/// bd, cd.
using CurvedTet = std::array<Point, 10>;

/// Returns the nodes of a tet. Precondition: mesh.order() == 2.
CurvedTet curved_tet(const TetMesh& mesh, Index tet);

/// Returns whether the Jacobian determinant of the map from the reference tetrahedron everywhere exceeds
/// `least` times that of the straight tetrahedron with the same corners. With `least` 0, tells whether the
/// element is valid. The answer rests on bounds, not samples: the determinant is a cubic polynomial, whose 20
/// Bernstein coefficients enclose it and equal it at the corners; the element is bisected until these bounds
/// decide (Johnen, Remacle and Geuzaine, Geometrical validity of curvilinear finite elements, 2013, section
/// 3). If rounding leaves it open, the answer is no. A tetrahedron with straight edges is valid when its
/// corners are positively oriented, by exact arithmetic. Precondition: 0 <= least < 1.
bool jacobian_exceeds(const CurvedTet& nodes, double least = 0);

}  // namespace collarmesh
