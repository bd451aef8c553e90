#pragma once

#include "collarmesh/periodic.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh::periodicity {

/// Returns a tolerance that fits both sides of each pair: at curves that are images of each other it is the
/// smaller of the two tolerances, and it rises slowly with the distance from them. So chords that fit one
/// side fit the other, too.
SurfaceTolerance tolerance_across(const SurfaceTolerance& tolerance, const Plc& plc,
                                  const PeriodicOptions& options, double distance);

}  // namespace collarmesh::periodicity
