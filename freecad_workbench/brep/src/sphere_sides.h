#pragma once

#include <STEPControl_Reader.hxx>
#include <TopoDS_Shape.hxx>
#include <cstddef>

namespace collarmesh::brep {

/// Mends spherical faces for which OpenCASCADE's reader chose the wrong side of their outline. An outline
/// through both poles divides a sphere into two parts. In the file, the direction of the outline says which
/// part the face is. If the outline lies on the seam, the reader may shift it by a period and then reverse
/// the face to make it fit. Such a face is oriented against the file, unlike the faces around it. Changes the
/// shape in place.
void mend_sphere_sides(const STEPControl_Reader& reader, const TopoDS_Shape& shape);

/// Gives a face of a shell the other side of its outline, and orients it so that it fits its neighbours.
/// `face` is its index in the shell. Changes the shell in place, but not the order of its faces. Returns
/// false, without changes, if the face does not lie on a sphere with both poles on its outline, or if the
/// result is invalid.
bool take_other_side(const TopoDS_Shape& shell, std::size_t face);

}  // namespace collarmesh::brep
