#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "periodic/motions.h"

namespace collarmesh::periodicity {

/// Copies of a complex, each moved as a whole, as one complex: feature f of copy k of a complex with n such
/// features has the number k n + f; likewise regions. Copies do not share features.
struct TiledComplex {
  TiledComplex(const Plc& plc, const SurfaceTolerance& tolerance, const std::vector<Motion>& copies);

  Plc plc;
  SurfaceTolerance tolerance;
};

}  // namespace collarmesh::periodicity
