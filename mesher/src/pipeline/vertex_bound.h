#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns far more vertices than refinement needs for a complex without features much finer than the sizes.
/// Sheets that part at a hundredth of a degree, needles and folds make millions. It does not
/// depend on how near features come to each other. Cost: linear; near linear where more is asked for than
/// target edge lengths everywhere and in regions.
std::size_t most_vertices_expected(const Plc& plc, const PipelineOptions& options);

/// The smallest target edge length that is given as a number, absolute.
double smallest_size(const MeshOptions& options, double diagonal);

}  // namespace collarmesh
