#pragma once

#include <functional>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns the complex with the long narrow strips of its smooth patches divided like ladders, if such strips
/// make up most of its surface: both long sides of a strip, and the long sides of the strips beside it, are
/// divided into equally many edges of at most about `size`, and rungs join the sides. So vertices around a
/// tube, and those on its two walls, face each other. `may_move`: by triangle of the complex, the distance by
/// which the surface may move when a diagonal of a strip is replaced by rungs. `diagonals`: if both
/// diagonals between two rungs are equally good, the one that extends farther in this direction is chosen.
/// Points, features and tags keep their indices; triangles do not. Cost: n log n.
Plc with_ladders(const Plc& plc, double size, const std::function<double(Index)>& may_move,
                 const Vector& diagonals = {0.36, 0.48, 0.8});

}  // namespace collarmesh
