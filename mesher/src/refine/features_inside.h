#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The complex without the patches outside all regions, and without curves and vertices that lie on no other
/// patch: no mesh has them, so they need no refinement. Points and regions keep their numbers.
class FeaturesInside {
 public:
  /// Keeps the complex by reference.
  explicit FeaturesInside(const Plc& complex);

  const Plc& plc() const { return reduced_ ? *reduced_ : complex_; }
  /// Returns the tolerance for `plc()`, made from one for the whole complex.
  SurfaceTolerance tolerance(const SurfaceTolerance& whole) const {
    return reduced_ ? whole.of_patches(complex_, patches_) : whole;
  }
  /// Replaces the features of a mesh of `plc()` by those of the whole complex.
  void restore_numbers(TetMesh& mesh) const;

 private:
  const Plc& complex_;
  std::optional<Plc> reduced_;                      // nothing if no feature lies outside
  std::vector<Index> vertices_, curves_, patches_;  // by kept feature: its number in the whole complex
};

}  // namespace collarmesh
