#pragma once

#include "collarmesh/periodic.h"
#include "collarmesh/surface_tolerance.h"

namespace collarmesh::periodicity {

/// Returns the tolerance with the smaller one of both sides at curves that are images of each other, and with
/// it rising slowly away from there. So chords that fit one side fit the other, too.
SurfaceTolerance tolerance_across(const SurfaceTolerance& tolerance, const Plc& plc,
                                  const PeriodicOptions& options, double distance);

}  // namespace collarmesh::periodicity
