#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "periodic/motions.h"

namespace collarmesh::periodicity {

/// Several copies of a complex, each moved rigidly, as one complex. Feature f of copy k has the number k n +
/// f if the complex has n such features; regions are numbered likewise. Copies do not share features.
struct TiledComplex {
  TiledComplex(const Plc& plc, const SurfaceTolerance& tolerance, const std::vector<Motion>& copies);

  Plc plc;
  SurfaceTolerance tolerance;
};

}  // namespace collarmesh::periodicity
