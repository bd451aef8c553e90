#pragma once

#include <STEPControl_Reader.hxx>
#include <TopoDS_Shape.hxx>
#include <cstddef>

namespace collarmesh::brep {

/// Mends faces of spheres that OpenCASCADE's reader took for the other side of their outline. An outline
/// through both poles divides a sphere into two parts. In the file, the direction of the outline says which
/// part the face is. If the outline lies on the seam, the reader may place it a period away and then turn the
/// face to make it fit. Such a face gets the opposite of its orientation in the file; the faces around it
/// keep theirs. Changes the shape in place.
void mend_sphere_sides(const STEPControl_Reader& reader, const TopoDS_Shape& shape);

/// Gives a face of a shell the other side of its outline, and turns it so that it fits its neighbours. The
/// face lies on a sphere and has both poles on its outline. Changes the shell in place, but not the order of
/// its faces. Returns whether that worked; if not, nothing is changed.
bool take_other_side(const TopoDS_Shape& shell, std::size_t face);

}  // namespace collarmesh::brep
