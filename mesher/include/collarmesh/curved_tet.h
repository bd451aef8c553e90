#pragma once

#include <array>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The nodes of a tetrahedron of second order: corners a, b, c, d, then those amid ab, bc, ca, ad, bd, cd.
using CurvedTet = std::array<Point, 10>;

/// Precondition: mesh.order() == 2.
CurvedTet curved_tet(const TetMesh& mesh, Index tet);

/// Is the Jacobian determinant of the map from the reference tetrahedron more than `least` times that of the
/// straight tetrahedron with the same corners, everywhere in it? With `least` 0: is the element valid?
/// Decided by bounds, not by samples: the determinant is a cubic polynomial, whose 20 Bernstein coefficients
/// enclose it and at the corners are its values; the element is bisected until that decides (Johnen, Remacle
/// and Geuzaine, Geometrical validity of curvilinear finite elements, 2013, section 3). Where rounding leaves
/// it open the answer is no. A tetrahedron with straight edges is valid when its corners are positively
/// oriented, by exact arithmetic.
/// Preconditions: 0 <= least < 1.
bool jacobian_exceeds(const CurvedTet& nodes, double least = 0);

}  // namespace collarmesh
