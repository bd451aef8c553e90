#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh {

/// Returns whether most elements of a refinement would lie in shells: curved walls and gaps much thinner than
/// the chords that keep the tolerance. There a refinement makes elements as short as the shell is thin, but a
/// mesh needs only elements as long as the chords. Cost: near linear in the triangles.
bool has_thin_shells(const Plc& plc, const SurfaceTolerance& tolerance, double size);

}  // namespace collarmesh
