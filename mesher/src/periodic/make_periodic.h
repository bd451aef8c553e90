#pragma once

#include "collarmesh/periodic.h"

namespace collarmesh::periodicity {

/// Which group of a pair keeps its mesh: the first, or the second.
enum class Direction { forward, backward };

/// As the public function, in either direction.
PeriodicReport make_periodic(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance,
                             Direction direction);

}  // namespace collarmesh::periodicity
