#pragma once

#include "collarmesh/periodic.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh::periodicity {

/// Returns a tolerance that, at curves that are images of each other, is the smaller one of both sides, and
/// rises slowly with the distance from there. So chords that fit one side fit the other, too.
SurfaceTolerance tolerance_across(const SurfaceTolerance& tolerance, const Plc& plc,
                                  const PeriodicOptions& options, double distance);

}  // namespace collarmesh::periodicity
