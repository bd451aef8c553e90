#pragma once

#include <cstdint>

#include "collar/collar_system.h"

namespace collarmesh {

/// Pseudo-random offsets of inserted points: with exact centres, cospherical input would lead to flat cells
/// whose refinement never ends. The refinement loop (`Refinement`) and the parts that it drives share one
/// sequence, so the order of their calls determines the mesh. BlockRefinement starts a sequence for each cell
/// or triangle, from its centre and the seed, so that the number of threads does not matter.
class RandomOffsets {
 public:
  /// Keeps the collars by reference.
  RandomOffsets(std::uint64_t seed, const CollarSystem& collars) : collars_(collars), state_(seed) {}

  /// Returns a vector with each coordinate from -1 to 1.
  Vector in_cube();
  /// Returns a vector that does not lead from this point into a collar; zero if none was found. Its
  /// coordinates are from -length to length; then it is projected onto the plane orthogonal to the normal,
  /// unless the normal is zero.
  Vector outside_collars(const Point& from, double length, const Vector& normal);

 private:
  const CollarSystem& collars_;
  std::uint64_t state_;
};

}  // namespace collarmesh
