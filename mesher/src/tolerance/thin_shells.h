#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh {

/// Returns whether a refinement would make far too many elements in shells: curved walls and gaps much
/// thinner than the chords that keep the tolerance. A refinement makes elements there as short as the shell
/// is thin, but a mesh needs only elements as long as the chords. No chord is longer than `size` (absolute).
/// Cost: near linear in the triangles.
bool has_thin_shells(const Plc& plc, const SurfaceTolerance& tolerance, double size);

}  // namespace collarmesh
