#pragma once

#include <cstddef>
#include <span>

#include "collarmesh/bounds.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::adapting {

/// Moves vertices inside regions to the mean of the centres of their tets where that raises the sum of the
/// tets' mean ratios and leaves all of them within the bounds on thin tets. `sizes` are targets at the
/// vertices: no edge that they find too long becomes longer. Returns the number of moves. The result is the
/// same for any number of threads. Cost: linear.
std::size_t smooth(TetMesh& mesh, const Plc& plc, const Bounds& bounds, std::span<const double> sizes,
                   const Execution& execution);

}  // namespace collarmesh::remeshing::adapting
