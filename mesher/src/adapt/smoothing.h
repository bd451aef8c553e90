#pragma once

#include <cstddef>

#include "collarmesh/bounds.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"
#include "remesh/metric.h"

namespace collarmesh::remeshing::adapting {

/// Moves vertices inside regions towards the mean of the centres of their tets where that raises the sum of
/// the tets' mean ratios and leaves all of them within the bounds on thin tets. No edge that the metric finds
/// too long becomes longer. Returns the number of moves. The result is the same for any number of threads.
/// Cost: linear.
std::size_t smooth(TetMesh& mesh, const Plc& plc, const Bounds& bounds, const Metric& metric,
                   const Execution& execution);

}  // namespace collarmesh::remeshing::adapting
