#pragma once

#include <gp_Pnt.hxx>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

inline Point to_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

}  // namespace collarmesh::brep
