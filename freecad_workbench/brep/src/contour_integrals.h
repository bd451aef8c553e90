#pragma once

#include <TopoDS_Face.hxx>
#include <gp_Pnt.hxx>

#include <optional>

namespace collarmesh::brep {

struct FaceMeasure {
  double area = 0;
  double cone = 0;  ///< signed volume of the cone over the face: positive if the face's normal points away
                    ///< from the apex
};

/// Measures a face by Green's theorem, which turns an integral over the face into one along its edges in the
/// parameter plane. The integrand there is an inner integral over one parameter. The inner integral is known
/// for planes, cylinders, cones, spheres and tori; for other surfaces it is computed span by span. The face's
/// own orientation does not count: its normals are those of its surface. Returns nothing if the face has no
/// edges, an edge has no curve on the surface, or the integrals do not converge within a limit on their cost.
std::optional<FaceMeasure> integrate_along_edges(const TopoDS_Face& face, const gp_Pnt& apex);

}  // namespace collarmesh::brep
