#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The complex without the patches outside of all regions and what lies on these alone: no mesh has them, so
/// nothing is refined for them. Points and regions keep their numbers.
class FeaturesInside {
 public:
  /// Kept by reference.
  explicit FeaturesInside(const Plc& complex);

  const Plc& plc() const { return reduced_ ? *reduced_ : complex_; }
  /// A tolerance of the whole complex, for `plc()`.
  SurfaceTolerance tolerance(const SurfaceTolerance& whole) const {
    return reduced_ ? whole.of_patches(complex_, patches_) : whole;
  }
  /// The features of a mesh of `plc()` become those of the whole complex.
  void restore_numbers(TetMesh& mesh) const;

 private:
  const Plc& complex_;
  std::optional<Plc> reduced_;                      // where something lies outside
  std::vector<Index> vertices_, curves_, patches_;  // of the whole complex, for each that is kept
};

}  // namespace collarmesh
